#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint:
// lint: EMITTERS=lights/two_levels
// A shadow ray from a catcher to one of several samples of the lights, chosen by the light that it would give:
// how often it is free gives the fraction of the light that arrives (resampling, Talbot et al. 2005).

layout(local_size_x = 64) in;

#include <ShadowCatcherParameters>
#include "common/iteration.glsl"
#include "common/active_paths.glsl"
#include "common/random.glsl"
#include "common/bsdf/closure.glsl"
#include "common/light_sets.glsl"
#include <LightLink>
uniform Parameters { ShadowCatcherParameters parameters; };
#include "lights/lights.glsl"
readonly buffer Closures;
readonly buffer Rays;
writeonly buffer ShadowRays;
writeonly buffer Contributions;
readonly buffer LightLinks;
writeonly buffer LightTriangles;
#include EMITTERS "lights/one_level/hits.glsl"

const int CANDIDATES = 64;

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    Ray none = Ray(vec3(0.0), NO_TRIANGLE, vec3(0.0, 0.0, 1.0), 0.0);
    shadow_rays[index] = none;
    contributions[index] = vec4(0.0);
    light_triangles[index] = NO_TRIANGLE;
    Closure closure = closures[index];
    if (!(rays[index].maximum_distance > 0.0) || !closure_hit(closure)
        || (closure.flags & CLOSURE_CATCHES_SHADOWS) == 0u)
        return;
    vec3 geometric = unpack_unit_vector(closure.geometric_normal), shading = unpack_unit_vector(closure.shading_normal);
    RandomSequence random = random_sequence(iteration.seed, iteration.number, STAGE_SHADOW_CATCHER, parameters.segment,
                                            parameters.first_pixel + index);
    uint light_set = light_set_of(triangle_vertices[3u * closure.triangle].w), chosen_link = 0u;
    float total = 0.0;
    Ray chosen = none;
    for (int k = 0; k < CANDIDATES; ++k) {
        float u = next_random(random), u_part = next_random(random), u_choice = next_random(random);
        vec2 u_place = next_random2(random);
        Light light = lights[choose_light((float(k) + u) / float(CANDIDATES))];
        LightSample sampled = sample_whole_light(light, closure.position, u_part, u_place);
        uint link = sampled.triangle == NO_EMITTER ? light.link : emitter_link(sampled.triangle);
        bool lights_diffuse = (light.flags & RAY_DIFFUSE) != 0u && sampled.triangle != hit_emitter(closure.triangle)
                              && has_set(light_links[link].light_sets, light_set);
        float given = largest(sampled.weight) * max(dot(shading, sampled.direction), 0.0) / light.selection_probability;
        if (!lights_diffuse || !(given > 0.0) || dot(geometric, sampled.direction) <= 0.0) continue;
        total += given;
        if (u_choice * total < given) {
            vec3 origin = closure.position + closure.ray_offset * geometric;
            float reach =
                sampled.distance < INFINITY_DISTANCE ? shadow_ray_length(sampled.distance) : INFINITY_DISTANCE;
            chosen = Ray(origin, closure.triangle, sampled.direction, reach);
            chosen_link = link;
            light_triangles[index] = keep_sampled_emitter(sampled.triangle, index);
        }
    }
    shadow_rays[index] = chosen;
    contributions[index].w = signed_code(false, chosen_link);
}
