#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Photons that a surface has sent on by its diffuse part: some of them go below before they leave.

layout(local_size_x = 64) in;

#include <EnterParameters>
#include <MediumScattering>
#include "common/iteration.glsl"
#include "common/active_paths.glsl"
uniform Parameters { EnterParameters parameters; };
readonly buffer Closures;
#include "photons/parts.glsl"
buffer PhotonPaths;
readonly buffer AdjointQueries;
#include "camera_paths/subsurface/entry.glsl"

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    walk_rays[index].maximum_distance = 0.0;
#ifdef MEDIA
    if ((photon_paths[index].flags & PATH_SCATTERED_IN_MEDIUM) != 0u) return;
#endif
    vec3 flux = photon_paths[index].flux;
    Closure closure = closures[index];
    if (!(largest(flux) > 0.0) || !has_subsurface(closure) || adjoint_queries[index].part != PART_DIFFUSE) return;
    Subsurface part = unpacked_subsurface(closure.lobes[CLOSURE_LOBES - 1]);
    RandomSequence random =
        random_sequence(iteration.seed, iteration.number, STAGE_SUBSURFACE_PHOTONS, parameters.segment, index);
    vec3 beside = diffuse_beside(closure, part);
    float below = largest(part.weight), probability = below / (below + largest(beside));
    vec3 weight = 1.0 / max(closure.diffuse, vec3(1e-20));
    bool walks = next_random(random) < probability;
    weight *= walks ? part.weight / probability : beside / (1.0 - probability);
    photon_paths[index].flux = flux * weight;
    if (!walks) return;
    // Camera paths come out evenly: photons go in so.
    vec3 direction = -sample_cosine_hemisphere(unpack_unit_vector(closure.geometric_normal), next_random2(random));
    begin_walk(index, closure, part, direction, weight * flux / largest(weight * flux));
}
