#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Cryptomatte: what the surface that a camera path comes to, straight ahead, covers of its pixel. As in Cycles each
// surface counts by how much of what lies behind it hides, shadow catchers as if they hid all of it, and what finds no
// place among the pairs of a pixel counts for the last one.

layout(local_size_x = 64) in;

#include <CryptomatteParameters>
#include <CryptomatteNames>
#include "common/iteration.glsl"
#include "common/active_paths.glsl"
#include "common/bsdf/closure.glsl"
#include "common/bsdf/ray_portal.glsl"
#include "common/camera_path.glsl"
uniform Parameters { CryptomatteParameters parameters; };
readonly buffer Closures;
readonly buffer Rays;
readonly buffer CameraPaths;
readonly buffer Attributes;
readonly buffer Identifiers { uint identifiers[]; };
// of a pixel so many pairs of an identifier, 0 where there is none yet, and the bits of its coverage
buffer Pairs { uvec2 pairs[]; };
// of a path of the band: 1 and the segment that ended at a catcher, or 0
buffer CaughtAfter { uint caught_after[]; };

uint first;  // pair of the pixel

// Make room for an iteration's path.
void begin_iteration() {
    float kept = float(iteration.number_in_film - 1u) / float(iteration.number_in_film);
    for (uint pair = first; pair < first + parameters.pair_count; pair++) {
        uvec2 held = pairs[pair];
        pairs[pair] =
            iteration.number_in_film == 1u ? uvec2(0u) : uvec2(held.x, floatBitsToUint(kept * uintBitsToFloat(held.y)));
    }
}

void cover(uint identifier, float coverage) {
    uint last = first + parameters.pair_count - 1u;
    for (uint pair = first; pair <= last; pair++) {
        uvec2 held = pairs[pair];
        if (held.x != 0u && held.x != identifier && pair != last) continue;
        pairs[pair] = uvec2(held.x == 0u ? identifier : held.x, floatBitsToUint(uintBitsToFloat(held.y) + coverage));
        return;
    }
}

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    first = parameters.pair_count * index;
    bool any_catchers = parameters.any_catchers != 0u;
    if (parameters.segment == 0u) {
        begin_iteration();
        if (any_catchers) caught_after[index] = 0u;
    }
    if (!(rays[index].maximum_distance > 0.0)) return;
    CameraPath path = camera_paths[index];
    Closure closure = closures[index];
    if ((path.flags & PATH_CAMERA_TRANSPARENT) == 0u || !closure_hit(closure) || closure_holdout(closure) >= 1.0)
        return;
    vec3 transparent = seen_beyond(closure), throughput = path.throughput;
    bool catches = (closure.flags & CLOSURE_CATCHES_SHADOWS) != 0u;
    // The layers follow each other: another one may have noted this very catcher.
    if (any_catchers && caught_after[index] != 0u && caught_after[index] <= parameters.segment) return;
    if (catches) caught_after[index] = parameters.segment + 1u;
    float hidden = catches ? 1.0 : 1.0 - (transparent.r + transparent.g + transparent.b) / 3.0;
    float coverage = hidden * (throughput.r + throughput.g + throughput.b) / 3.0;
    if (!(coverage > 0.0)) return;
    bool by_material = parameters.names == NAMES_OF_MATERIALS;
    uint name = by_material ? closure.material : attributes[closure.triangle].instance;
    cover(identifiers[name], coverage / float(iteration.number_in_film));
}
