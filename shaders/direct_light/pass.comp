#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint:
// lint: MEDIA=1
// lint: MEDIA=1 HETEROGENEOUS_MEDIA=1
// Continues shadow rays behind a transparent surface, weighted by its transmittance. The transparent surfaces that the
// camera path has crossed count towards the limit as well, as in Cycles.

layout(local_size_x = 64) in;

#include "common/iteration.glsl"
#include "common/constants.glsl"
#include "common/geometry.glsl"
#include "common/active_paths.glsl"
#include "common/path_depth.glsl"
#include "direct_light/rest_of_ray.glsl"
#include <CameraPath>
#include <PassSurfaceParameters>

uniform Parameters { PassSurfaceParameters parameters; };
readonly buffer Closures;
buffer ShadowRays;
buffer Contributions;
readonly buffer CameraPaths;
#ifdef MEDIA
readonly buffer Media;
buffer ShadowMedia;
#include "common/bsdf/closure.glsl"
#include "common/transparency.glsl"
#include "materials/medium.glsl"
#endif

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    Ray ray = shadow_rays[index];
    uint surfaces = transparents_of(camera_paths[index].depth) + parameters.surface_count;
    bool passes = surfaces < iteration.transparent_max_bounces;
#ifdef MEDIA
    // Surfaces of volumes alone are not counted: below its media, the word has their number.
    uint media_flags = shadow_media[index];
    surfaces -= min(media_flags & PATH_MASK, surfaces);
    bool counts = counts_as_transparent(closures[index]);
    passes = surfaces < iteration.transparent_max_bounces || !counts;
    shadow_media[index] =
        cross_surface(media_flags, closures[index].material, closure_backfacing(closures[index])) + (counts ? 0u : 1u);
#endif
    vec3 transmittance = passes ? closures[index].transparent : vec3(0.0);
#ifdef MEDIA
    transmittance *= segment_transmittance(media_flags, ray.origin, ray.direction, closures[index].distance);
#endif
    contributions[index].rgb *= transmittance;
    shadow_rays[index].maximum_distance = 0.0;
    if (!(largest(transmittance) > 0.0)) return;
    // Closures' normals look back along the ray.
    vec3 normal = -unpack_unit_vector(closures[index].geometric_normal);
    vec3 origin = closures[index].position + closures[index].ray_offset * normal;
    shadow_rays[index] = rest_of_ray(ray, origin, closures[index].triangle);
}
