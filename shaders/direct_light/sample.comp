#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Next-event rays from importons to a sampled light.

layout(local_size_x = 64) in;

#include <Ray>
#include <DirectLightParameters>
#include "common/invocation.glsl"
#include "common/random.glsl"
#include "common/importon.glsl"
layout(std140, binding = 0) uniform Parameters { DirectLightParameters parameters; };
#include "emission/lights.glsl"
layout(std430, binding = 0) readonly buffer Importons { Importon importons[]; };
layout(std430, binding = 1) writeonly buffer Rays { Ray rays[]; };
layout(std430, binding = 2) writeonly buffer Contributions { vec4 contributions[]; };

uint choose_light(float u) {
    uint low = 0u, high = parameters.light_count - 1u;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (lights[middle].selection_end > u) high = middle;
        else low = middle + 1u;
    }
    return low;
}

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    rays[index].maximum_distance = 0.0;
    contributions[index] = vec4(0.0);
    Importon importon = importons[index];
    if (!(importon.radius > 0.0)) return;
    RandomSequence random = random_sequence(parameters.seed, parameters.iteration, STAGE_DIRECT_LIGHT, parameters.segment, parameters.first_pixel + index);
    Light light = lights[choose_light(next_random(random))];
    float u_choice = next_random(random);
    LightSample sampled = sample_light(light, importon.position, u_choice, next_random2(random));
    if (!(largest(sampled.weight) > 0.0) || sampled.triangle == importon.triangle) return;
    vec3 geometric = unpack_unit_vector(importon.geometric_normal), shading = unpack_unit_vector(importon.shading_normal);
    float side = dot(geometric, sampled.direction), cosine = dot(shading, sampled.direction);
    if (side * cosine <= 0.0) return;
    vec3 radiance = evaluate_importon(importon, shading, sampled.direction) * sampled.weight
                  * (abs(cosine) / light.selection_probability);
    if (!(largest(radiance) > 0.0)) return;
    contributions[index] = vec4(radiance, 0.0);
    vec3 origin = offset_from_surface(importon.position, side > 0.0 ? geometric : -geometric);
    // Short of the light, whose own surface must not hide it.
    rays[index] = Ray(origin, importon.triangle, sampled.direction, sampled.distance * (1.0 - 1e-4));
}
