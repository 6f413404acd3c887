#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Lights chosen at points, and what rays pass of the light objects: by the tree, and of all one by one.

layout(local_size_x = 64) in;

#include <LightChoicesParameters>
#include "common/invocation.glsl"
#include "common/random.glsl"
uniform Parameters { LightChoicesParameters parameters; };
#include "materials/medium.glsl"
#include "lights/light_tree.glsl"
writeonly buffer Results { vec4 results[]; };

#ifdef EMITTERS
// Of a chosen emissive triangle, its leaf, and a number that no other one has.
EmitterNumber chosen_leaf(EmitterNumber emitter) {
    uint triangle = emissive_triangles[emitter.y].triangle;
    if (is_of_instance(emitter)) return uvec2(emitter.x, triangle);
    return in_world(uint(triangle_vertices[3u * triangle + 1u].w));
}
uint number_of(EmitterNumber emitter) { return emitter.y + (is_of_instance(emitter) ? (emitter.x + 1u) << 20u : 0u); }
#else
EmitterNumber chosen_leaf(EmitterNumber emitter) {
    return uint(triangle_vertices[3u * emissive_triangles[emitter].triangle + 1u].w);
}
uint number_of(EmitterNumber emitter) { return emitter; }
#endif

// What rays that meet the light of a choice tell of its probability; of the environment none do.
float told_probability(LightChoice choice, LitPoint point) {
    uint kind = lights[choice.light].kind;
    EmitterNumber leaf = in_world(0u);
    if (kind == LIGHT_WORLD) return choice.probability;
    if (kind == LIGHT_MESH) {
        leaf = chosen_leaf(choice.triangle);
        return light_probability(point, iteration.environment_irradiance, KIND_TRIANGLES, leaf);
    }
    for (uint sun = 0u; sun < iteration.sun_count; ++sun)
        if (light_nodes[iteration.first_sun + sun].member == choice.light)
            return light_probability(point, iteration.environment_irradiance, KIND_FIRST_SUN + sun, leaf);
    for (uint node = iteration.light_tree_leaves; node < 2u * iteration.light_tree_leaves; ++node)
        if (light_nodes[node].member == choice.light) leaf = in_world(node);
    return light_probability(point, iteration.environment_irradiance, KIND_OBJECTS, leaf);
}

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    RandomSequence random = random_sequence(iteration.seed, 1u, 1u, 0u, index);
    if (parameters.looks_at_lights != 0u) {
        vec3 origin = 4.0 * (vec3(next_random(random), next_random2(random)) - 0.5),
             direction = sample_sphere(next_random2(random));
        vec3 all = vec3(0.0);
        for (uint light = 0u; light < iteration.light_count; ++light) {
            float distance, pdf;
            all += intersected_radiance(lights[light], origin, direction, parameters.reach, distance, pdf);
        }
        ScatterPoint from = ScatterPoint(LitPoint(origin, vec3(0.0), false, 0u), 0.0, 0.0, false, 0u);
        IntersectedLights passed =
            intersect_lights(from, direction, vec2(0.0, parameters.reach), RAYS_WITH_VISIBILITY, 0.0, 0u);
        results[index] = vec4(passed.radiance.xy, all.xy);
        return;
    }
    // Evenly spaced numbers: each choice gets the part of them that is its probability.
    float u = (float(index) + 0.5) / float(parameters.count);
    LitPoint point = LitPoint(parameters.point, parameters.normal, parameters.both_sides != 0u, 0u);
    LightChoice choice = choose_light_at(point, iteration.environment_irradiance, u, next_random(random));
    results[index] = vec4(uintBitsToFloat(choice.light), uintBitsToFloat(number_of(choice.triangle)),
                          choice.probability, told_probability(choice, point));
}
