#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// What photons straight from their lights meet: objects that these do not shine on scatter nothing of it, and those
// that cast no shadow in it let it pass, beside what they scatter.

layout(local_size_x = 64) in;

#include <LightLink>
#include "common/active_paths.glsl"
#include "common/photon.glsl"
#include "common/light_sets.glsl"
#include "common/bsdf/closure.glsl"
buffer Closures;
readonly buffer PhotonPaths;
readonly buffer PhotonLinks;
readonly buffer LightLinks;
readonly buffer Triangles;

void main() {
    uint index = active_path();
    if (index == NO_PATH || (photon_paths[index].flags & PHOTON_DIRECT) == 0u) return;
    uint triangle = closures[index].triangle;
    if (triangle == NO_TRIANGLE) return;
    LightLink link = light_links[photon_links[index]];
    uint flags = closures[index].flags;
    float code = triangle_vertices[3u * triangle].w;
    if (!has_set(link.light_sets, light_set_of(code))) {
        closures[index].diffuse = vec3(0.0);
        closures[index].translucent = vec3(0.0);
        flags &= ~(3u << LOBE_COUNT_SHIFT);
    }
    if (!has_set(link.shadow_sets, shadow_set_of(code))) {
        closures[index].transparent = vec3(1.0);
        flags |= CLOSURE_SHADOWLESS | CLOSURE_ABSENT;
    }
    closures[index].flags = flags;
}
