#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Samples of one light from a point, and what a ray in the sampled direction sees of it.

layout(local_size_x = 64) in;

#include <LightSamplesParameters>
#include "common/invocation.glsl"
#include "common/random.glsl"
uniform Parameters { LightSamplesParameters parameters; };
#include "lights/lights.glsl"
writeonly buffer Results { vec4 results[]; };

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    RandomSequence random = random_sequence(iteration.seed, 1u, 1u, 0u, index);
    float u_choice = next_random(random);
    LightSample sampled = sample_whole_light(lights[0], parameters.point, u_choice, next_random2(random));
    float distance = 0.0, pdf = 0.0;
    vec3 seen = vec3(0.0);
    if (sampled.triangle != NO_TRIANGLE) {
        seen = vec3(parameters.emitted);
        pdf = emissive_triangle_pdf(parameters.point, sampled.triangle);
        for (uint emissive = 0u; emissive < iteration.emissive_triangle_count; ++emissive)
            if (emissive_triangles[emissive].triangle == sampled.triangle)
                pdf *= emissive_triangles[emissive].probability;
    } else if (sampled.distance > 0.0)
        seen = intersected_radiance(lights[0], parameters.point, sampled.direction, INFINITY_DISTANCE, distance, pdf);
    results[3u * index] = vec4(sampled.direction, sampled.distance);
    results[3u * index + 1u] = vec4(sampled.weight, sampled.pdf);
    results[3u * index + 2u] = vec4(seen, pdf);
}
