// SPDX-License-Identifier: GPL-3.0-or-later
// Emissive triangles of which some are those of instances that rays place in the world
// (rppm_addon/integrator/lights/emitters/instances.py). Those of a mesh have their records once, in object space.
#include "common/placed_point.glsl"
#include "common/random.glsl"

uint emitter_number(EmitterNumber emitter) { return emitter.y; }

// What all triangles of the instance have in common, or those of a world triangle.
uint common_traits(EmitterNumber triangle) {
    return is_of_instance(triangle) ? emitter_instance(triangle.x).traits : emitter_traits(triangle.y);
}

uint emitter_link(EmitterNumber triangle) { return common_traits(triangle) >> EMITTER_LINK_SHIFT; }

bool emitter_is_hidden_from_media(EmitterNumber triangle) {
    return (common_traits(triangle) & EMITTER_HIDDEN_FROM_MEDIA) != 0u;
}

// The leaf of a triangle that a ray has hit, of which the number is 0 where it does not emit.
EmitterNumber emitter_leaf(uint triangle) {
    EmitterNumber emitter = hit_emitter(triangle);
    if (!is_of_instance(emitter)) return in_world(uint(triangle_vertices[3u * triangle + 1u].w));
    EmitterInstance instance = emitter_instance(emitter.x);
    if (instance.leaves == 0u) return in_world(0u);
    return uvec2(emitter.x, emissive_triangles[instance.first_emitter + emitter.y].triangle);
}

// The light sets of a triangle that emits (common/light_sets.glsl).
float emitter_set_code(EmitterNumber triangle) {
    return is_of_instance(triangle) ? emitter_instance(triangle.x).set_code : triangle_vertices[3u * triangle.y].w;
}

mat3 instance_linear(EmitterInstance instance) {
    return transpose(mat3(instance.row0.xyz, instance.row1.xyz, instance.row2.xyz));
}

// A place in an instance's mesh in the world.
vec3 placed(EmitterInstance instance, vec3 point) {
    vec3 origin = vec3(instance.row0.w, instance.row1.w, instance.row2.w);
    return placed_point(instance_linear(instance), origin, point - instance.pivot);
}

// The corners of a triangle of an instance's mesh in the world, as acceleration/instances.glsl places them.
void instance_corners(EmitterInstance instance, uint triangle, out vec3 v0, out vec3 v1, out vec3 v2) {
    uint first = 3u * (instance.first_triangle + triangle), turned = instance.mirrored;
    v0 = placed(instance, triangle_vertices[first].xyz);
    v1 = placed(instance, triangle_vertices[first + 1u + turned].xyz);
    v2 = placed(instance, triangle_vertices[first + 2u - turned].xyz);
}

EmissiveTriangle read_emitter(EmitterNumber emitter, out EmitterNumber triangle, out vec3 v0, out vec3 v1,
                              out vec3 v2) {
    EmissiveTriangle emissive = emissive_triangles[emitter.y];
    if (is_of_instance(emitter)) {
        EmitterInstance instance = emitter_instance(emitter.x);
        triangle = uvec2(emitter.x, emitter.y - instance.first_emitter);
        instance_corners(instance, triangle.y, v0, v1, v2);
    } else {
        triangle = in_world(emissive.triangle);
        triangle_corners(emissive.triangle, v0, v1, v2);
    }
    return emissive;
}

// The first of some emissive triangles that follow each other whose cumulated probability is above a number.
uint search_emissive_triangle(uint first, uint count, float u) {
    uint low = first, high = first + count - 1u;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (emissive_triangles[middle].cumulated > u) high = middle;
        else low = middle + 1u;
    }
    return low;
}

uint search_emitter_instance(float u) {
    uint low = 0u, high = emitter_levels().instance_count - 1u;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (emitter_instance(middle).cumulated > u) high = middle;
        else low = middle + 1u;
    }
    return low;
}

// By power: of the world's triangles and the instances, then of the instance's mesh. place: random numbers for more
// bits than the 24 of u, of whose steps an instance may take few.
EmitterNumber choose_emitter(float u, vec2 place, out float probability) {
    uint count = uint(iteration.emissive_triangle_count);
    if (count > 0u && u < emissive_triangles[count - 1u].cumulated) {
        uint index = search_emissive_triangle(0u, count, u);
        probability = emissive_triangles[index].probability;
        return in_world(index);
    }
    uint number = search_emitter_instance(u);
    EmitterInstance instance = emitter_instance(number);
    float before = instance.cumulated - instance.probability, steps = instance.probability * 16777216.0;
    float fine = unit_float(pcg4d(uvec4(floatBitsToUint(u), floatBitsToUint(place), iteration.number)).x);
    float within = clamp(((u - before) * 16777216.0 + fine) / steps, 0.0, 0.99999994);
    uint index = search_emissive_triangle(instance.first_emitter, instance.emitter_count, within);
    probability = instance.probability * emissive_triangles[index].probability;
    return uvec2(number, index);
}

#include "lights/triangle_point.glsl"

TrianglePoint sample_emissive_triangle(float u_triangle, vec2 u) {
    float probability;
    EmitterNumber triangle, emitter = choose_emitter(u_triangle, u, probability);
    vec3 v0, v1, v2;
    EmissiveTriangle emissive = read_emitter(emitter, triangle, v0, v1, v2);
    float root = sqrt(u.x);
    vec3 position = (1.0 - root) * v0 + root * (1.0 - u.y) * v1 + root * u.y * v2;
    vec3 across = cross(v1 - v0, v2 - v0);
    float area = 0.5 * length(across);
    vec3 normal = across / max(2.0 * area, 1e-30);
    return TrianglePoint(position, normal, triangle, sampled_radiance(emissive), probability / max(area, 1e-30),
                         ray_offset(normal, v0, v1, v2));
}
