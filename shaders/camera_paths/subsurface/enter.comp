#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Camera paths that have come to a surface with subsurface scattering: some of them go below, and others have to do
// with all else that the surface does. The latter and those that do not come out again have their closures here.

layout(local_size_x = 64) in;

#include <EnterParameters>
#include "common/iteration.glsl"
#include "common/active_paths.glsl"
#include "common/low_discrepancy.glsl"
uniform Parameters { EnterParameters parameters; };
readonly buffer Closures;
#include "common/bsdf/stored_lobes.glsl"
readonly buffer Rays;
writeonly buffer ExitClosures;
#include "camera_paths/subsurface/entry.glsl"
#include "camera_paths/subsurface/surface.glsl"

// Neither is left to fewer paths than this.
const float LEAST_SHARE = 0.25;

// The probability of going below.
float below_probability(uint index, Closure closure, Subsurface part, vec3 viewer) {
    float below = largest(part.weight);
    float others = largest(diffuse_beside(closure, part)) + largest(closure.translucent) + largest(closure.transparent)
                   + largest(closure.emission);
    for (int k = 0; k < closure_lobes(closure); ++k) {
        MicrofacetLobe lobe = stored_lobe(index, k);
        others += largest(lobe_albedo(lobe, lobe_cosine(lobe, viewer)));
    }
    return others > 0.0 ? clamp(below / (below + others), LEAST_SHARE, 1.0 - LEAST_SHARE) : 1.0;
}

void scale_lobes(inout Closure closure, float factor) {
    for (int k = 0; k < CLOSURE_LOBES; ++k) {
        closure.lobes[k].weight *= factor;
        if (passes_by_f0(unpack_kind(closure.lobes[k].kind))) closure.lobes[k].f0 *= factor;
    }
}

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    walk_rays[index].maximum_distance = 0.0;
    Closure closure = closures[index];
    if (!closure_hit(closure) || !has_subsurface(closure)) {
        exit_closures[index] = closure;
        return;
    }
    Subsurface part = unpacked_subsurface(closure.lobes[CLOSURE_LOBES - 1]);
    vec3 viewer = -rays[index].direction;
    uvec4 choices =
        pcg4d(uvec4(parameters.first_path + index, parameters.segment, iteration.seed, STAGE_SUBSURFACE << 24u));
    vec4 u =
        vec4(scrambled_sobol(iteration.number - 1u, choices), scrambled_sobol(iteration.number - 1u, pcg4d(choices)));
    float probability = below_probability(index, closure, part, viewer);
    if (u.w < probability) {
        vec3 direction =
            entered(part, unpack_unit_vector(part.normal), unpack_unit_vector(closure.geometric_normal), viewer, u.xyz);
        begin_walk(index, closure, part, direction, part.weight / probability);
        closure.diffuse = closure.translucent = closure.transparent = closure.emission = vec3(0.0);
        closure.flags &= ~(3u << LOBE_COUNT_SHIFT);
    } else {
        float factor = 1.0 / (1.0 - probability);
        closure.diffuse = diffuse_beside(closure, part) * factor;
        closure.translucent *= factor;
        closure.transparent *= factor;
        closure.emission *= factor;
        scale_lobes(closure, factor);
    }
    exit_closures[index] = closure;
}
