#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Where photons come out from below a surface they leave it by what a viewer sees of it there. Those that do not come
// out are absorbed.

layout(local_size_x = 64) in;

#include <EnterParameters>
#include "common/iteration.glsl"
#include "common/active_paths.glsl"
#include "common/random.glsl"
#include "common/sampling.glsl"
uniform Parameters { EnterParameters parameters; };
#include "camera_paths/subsurface/exit.glsl"
#include "camera_paths/subsurface/surface.glsl"
buffer PhotonPaths;
writeonly buffer Rays;
writeonly buffer Hits;
// Where they have gone in.
readonly buffer Closures;

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    vec3 flux = largest(photon_paths[index].flux) * subsurface_walks[index].throughput;
    Hit hit = exit_hits[index];
    WalkExit exit_point;
    vec3 direction;
    if (hit.triangle == NO_TRIANGLE) flux = vec3(0.0);
    else {
        exit_point = read_exit(index);
        RandomSequence random =
            random_sequence(iteration.seed, iteration.number, STAGE_SUBSURFACE_PHOTONS, parameters.segment, index);
        random.key.w += 0xf00u;
        Subsurface part = unpacked_subsurface(closures[index].lobes[CLOSURE_LOBES - 1]);
        vec3 u = vec3(next_random2(random), next_random(random));
        float weight;
        direction = left_by(part, exit_point.shading, exit_point.geometric, walk_rays[index].direction, u, weight);
        flux *= weight;
    }
    if (!(largest(flux) > 0.0)) {
        photon_paths[index].flux = vec3(0.0);
        rays[index].maximum_distance = 0.0;
        return;
    }
    photon_paths[index].flux = flux;
    hits[index] = hit;
    // Turned, to look at the surface from where the photon goes (photons/adjoint.comp).
    vec3 origin = exit_point.position + exit_point.ray_offset * exit_point.geometric;
    rays[index] = Ray(origin, hit.triangle, -direction, INFINITY_DISTANCE);
}
