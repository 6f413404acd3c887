#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint:
// lint: SPHERICAL_STEREO=1
// DirectCameraHits where no rasterization can serve: rays to be traced, and fresh camera paths.

layout(local_size_x = 64) in;

#include <PrimaryRaysParameters>
#include "common/iteration.glsl"
#include "common/invocation.glsl"
#include "common/low_discrepancy.glsl"
#include "common/camera_path.glsl"
uniform Parameters { PrimaryRaysParameters parameters; };
readonly buffer Camera;
writeonly buffer Rays;
writeonly buffer CameraPaths;
#include "camera_paths/gbuffer/aperture.glsl"
#include "camera_paths/gbuffer/panorama.glsl"
#ifdef SPHERICAL_STEREO
#include "camera_paths/primary_rays/spherical_stereo.glsl"
#endif

void main() {
    uint index = invocation_index();
    if (index >= camera.width * camera.height) return;
    // The points of a pixel cover the lens evenly as the iterations go by, and those of its neighbors are others.
    uvec4 choices = pcg4d(uvec4(parameters.first_pixel + index, 0u, iteration.seed, STAGE_CAMERA << 24u));
    vec2 lens = aperture_point(scrambled_sobol(max(iteration.number, 1u) - 1u - 1u, choices)), at = window_point(index);
    CameraRay ray = camera.projection <= PROJECTION_ORTHOGRAPHIC ? plane_ray(at, lens) : panorama_ray(at, lens);
    Ray seen = camera_is_sheared() ? sheared_ray(ray) : world_ray(ray);
#ifdef SPHERICAL_STEREO
    seen = spherical_stereo_ray(seen, ray.start_distance);
#endif
    rays[index] = seen;
    camera_paths[index] = CameraPath(vec3(1.0), 0.0, ray.start_distance, 0.0, sqrt(ray.area / PI),
                                     PATH_CAMERA_TRANSPARENT, 0u, 0u, 0u, 0.0, 0u, 0u, NO_PDF, 1.0);
}
