// SPDX-License-Identifier: GPL-3.0-or-later
// A surface as it was before its vertices were moved.

#include "materials/nodes/geometry.glsl"

// The same place of the mesh where it lay; layer: of the positions before.
Surface undisplaced(Surface surface, uint layer) {
    if (attribute_place(surface, layer).y < 3u) return surface;
    ShadingInstance at = shading_instances[surface.instance];
    vec3 origin = vec3(at.to_object0.w, at.to_object1.w, at.to_object2.w);
    surface.position = direction_to_world(surface, attribute_value(surface, layer).xyz - origin);
    return surface;
}

// Where a way across the surface led there.
vec3 undisplaced_way(Surface surface, vec3 way, uint layer) {
    return undisplaced(surface_beside(surface, way), layer).position - undisplaced(surface, layer).position;
}
