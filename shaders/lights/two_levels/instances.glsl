// SPDX-License-Identifier: GPL-3.0-or-later
// Records of emissive instances that rays place in the world (rppm_addon/integrator/lights/emitters/instances.py). They
// are read as texels: programs that sample lights in media have no storage block left.
#include <EmitterLevels>
#include <EmitterInstance>

#ifdef EMITTERS
layout(rgba32ui) restrict readonly uniform uimageBuffer EmitterInstances;
#endif

EmitterLevels emitter_levels() {
    uvec4 t = imageLoad(EmitterInstances, 0);
    return EmitterLevels(t.x, t.y, t.z, t.w);
}

EmitterInstance emitter_instance(uint number) {
    int first = 1 + 7 * int(number);
    vec4 row0 = uintBitsToFloat(imageLoad(EmitterInstances, first));
    vec4 row1 = uintBitsToFloat(imageLoad(EmitterInstances, first + 1));
    vec4 row2 = uintBitsToFloat(imageLoad(EmitterInstances, first + 2));
    uvec4 place = imageLoad(EmitterInstances, first + 3), mesh = imageLoad(EmitterInstances, first + 4),
          leaf = imageLoad(EmitterInstances, first + 5), choice = imageLoad(EmitterInstances, first + 6);
    return EmitterInstance(row0, row1, row2, uintBitsToFloat(place.xyz), place.w, mesh.x, mesh.y, mesh.z, mesh.w,
                           leaf.x, leaf.y, uintBitsToFloat(leaf.z), uintBitsToFloat(leaf.w), uintBitsToFloat(choice.x),
                           uintBitsToFloat(choice.y), choice.z);
}
