#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint:
// lint: MEDIA=1
// lint: MEDIA=1 HETEROGENEOUS_MEDIA=1
// What shadow rays meet: nothing, and the light arrives; an opaque surface; or one that may be transparent, which is to
// be resolved. Rays are inactive once that is settled.

layout(local_size_x = 64) in;

#include <Hit>
#include "common/geometry.glsl"
#include "common/constants.glsl"
#include "common/active_paths.glsl"
readonly buffer Hits;
readonly buffer Attributes;
readonly buffer Materials;
#ifdef MEDIA
readonly buffer Media;
readonly buffer ShadowMedia;
buffer Contributions;
#include "materials/medium.glsl"
#endif
buffer ShadowRays;
writeonly buffer Visibility;

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    uint triangle = hits[index].triangle;
    bool free = triangle == NO_TRIANGLE;
    // Of more surfaces than are asked for none lets light pass.
    visibility[index] = free ? 1u : 0u;
#ifdef MEDIA
    if (free) {
        Ray ray = shadow_rays[index];
        contributions[index].rgb *=
            segment_transmittance(shadow_media[index], ray.origin, ray.direction, ray.maximum_distance);
    }
#endif
    if (free || materials[attributes[triangle].material].passes_shadow_rays == 0u)
        shadow_rays[index].maximum_distance = 0.0;
}
