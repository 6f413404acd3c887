#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// The light objects that camera paths pass, by their groups, before the paths scatter on. Beside, a path then meets
// light of one group (seen.comp): what its radiance gets beyond what is left here.

layout(local_size_x = 64) in;

#include <PassedLightParameters>
#include "common/iteration.glsl"
#include "common/active_paths.glsl"
#include "common/low_discrepancy.glsl"
#include "common/bsdf/closure.glsl"
#include "common/camera_path.glsl"
#include "common/gathering.glsl"
uniform Parameters { PassedLightParameters parameters; };
#include "film/light_groups/grouped.glsl"
readonly buffer Closures;
readonly buffer Rays;
readonly buffer CameraPaths;
readonly buffer Radiances;
writeonly buffer SeenLight;
readonly buffer LightGroupTable;
readonly buffer FinalGatherOrigins;
readonly buffer FinalGatherHits;
readonly buffer Materials;
#include "materials/medium.glsl"

uint path_index;
vec3 path_throughput;
void add_passed_light(uint light, vec3 radiance) {
    add_to_group(path_index, light_group_table[light], false, path_throughput * radiance);
}
#define REPORT_PASSED_LIGHT add_passed_light
#include "lights/light_tree.glsl"
#include "camera_paths/importons/scatter_point.glsl"

void main() {
    path_index = active_path();
    if (path_index == NO_PATH) return;
    Ray ray = rays[path_index];
    vec3 passed = vec3(0.0);
    CameraPath path = camera_paths[path_index];
    if (ray.maximum_distance > 0.0 && path_collects_emission(path) && (path.flags & PATH_LIGHTS_FOUND) == 0u) {
        path_throughput = path.throughput;
        if (is_final_gather(path)) path_throughput *= final_gather_origins[path_index].weight;
        float distance = closure_hit(closures[path_index]) ? closures[path_index].distance : INFINITY_DISTANCE;
        passed = path_throughput
                 * visible_light(scatter_point(path_index, path, ray), ray, distance, camera_ray_kind(path.flags),
                                 path_absorption(path.flags));
    }
    seen_light[path_index] = vec4(radiances[path_index].rgb + passed, 0.0);
}
