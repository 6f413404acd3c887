#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint:
// lint: MEDIA=1
// lint: MEDIA=1 HETEROGENEOUS_MEDIA=1
// lint: MEDIA=1 EMISSIVE_MEDIA=1
// lint: MEDIA=1 HETEROGENEOUS_MEDIA=1 EMISSIVE_MEDIA=1
// Adds the light objects that the rays of camera paths intersect to their groups, before the paths are scattered. All
// other emission at the end of a ray is of one group: emission.comp adds the radiance beyond what is kept here. Media
// along the ray have groups of their own.

layout(local_size_x = 64) in;

#include <LightObjectParameters>
#include "common/iteration.glsl"
#include "common/active_paths.glsl"
#include "common/low_discrepancy.glsl"
#include "common/bsdf/closure.glsl"
#include "common/camera_path.glsl"
#include "common/gathering.glsl"
uniform Parameters { LightObjectParameters parameters; };
#include "film/light_groups/grouped.glsl"
readonly buffer Closures;
readonly buffer Rays;
readonly buffer CameraPaths;
readonly buffer Radiances;
writeonly buffer RadianceBefore;
readonly buffer LightGroupTable;
readonly buffer FinalGatherOrigins;
readonly buffer FinalGatherHits;
readonly buffer Media;
#include "materials/medium.glsl"

#ifdef EMISSIVE_MEDIA
#include "film/light_groups/media.glsl"
#endif

uint path_index;
vec3 path_throughput;
void add_intersected_light(uint light, vec3 radiance) {
    add_to_group(path_index, light_group_table[light], false, path_throughput * radiance);
}
#define REPORT_INTERSECTED_LIGHT add_intersected_light
#include "lights/light_tree.glsl"
#include "camera_paths/importons/scatter_point.glsl"

void main() {
    path_index = active_path();
    if (path_index == NO_PATH) return;
    Ray ray = rays[path_index];
    vec3 ungrouped = vec3(0.0), light_objects = vec3(0.0);
    CameraPath path = camera_paths[path_index];
    float distance = closure_hit(closures[path_index]) ? closures[path_index].distance : INFINITY_DISTANCE;
#ifdef MEDIA
    if (ray.maximum_distance > 0.0 && !is_final_gather(path))
        ungrouped = path.throughput * segment_emission(path.flags, ray.origin, ray.direction, distance);
#endif
#ifdef EMISSIVE_MEDIA
    if (ray.maximum_distance > 0.0) add_emission_of_media(path_index, path, ray, distance);
#endif
    if (ray.maximum_distance > 0.0 && path_collects_emission(path) && (path.flags & PATH_LIGHTS_FOUND) == 0u) {
        path_throughput = path.throughput;
        if (is_final_gather(path)) path_throughput *= final_gather_origins[path_index].weight;
        light_objects = path_throughput
                        * visible_light(scatter_point(path_index, path, ray), ray, distance,
                                        camera_ray_kind(path.flags), path.flags);
    }
    radiance_before[path_index] = vec4(radiances[path_index].rgb + ungrouped + light_objects, 0.0);
}
