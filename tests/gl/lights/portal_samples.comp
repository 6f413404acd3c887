#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint: PORTALS=1
// Samples of the world from a point, by portals and by its map, and the pdf of even directions.

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
    LightSample sampled = sample_light(lights[iteration.world_light], 0u, parameters.point, next_random2(random));
    vec3 even = sample_sphere(next_random2(random));
    results[3u * index] = vec4(sampled.direction, sampled.distance);
    results[3u * index + 1u] = vec4(sampled.weight, sampled.pdf);
    results[3u * index + 2u] = vec4(even, mixed_world_pdf(view_portals(parameters.point, even, NO_PORTAL), even));
}
