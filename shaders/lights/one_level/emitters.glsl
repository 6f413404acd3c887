// SPDX-License-Identifier: GPL-3.0-or-later
// Emissive triangles that all lie in the world. lights/two_levels/emitters.glsl stands in for this file where some are
// those of instances.

// A number of an emissive triangle, of a world triangle that emits, or of a leaf of the light tree.
#define EmitterNumber uint
const EmitterNumber NO_EMITTER = NO_TRIANGLE;

EmitterNumber in_world(uint number) { return number; }
uint emitter_number(EmitterNumber emitter) { return emitter; }

// A triangle that a ray has hit, as emitters are numbered.
EmitterNumber hit_emitter(uint triangle) { return triangle; }

// The LightLink of a triangle that emits.
uint emitter_link(EmitterNumber triangle) { return emitter_traits(triangle) >> EMITTER_LINK_SHIFT; }

// The leaf of a triangle that a ray has hit; 0 where it does not emit.
EmitterNumber emitter_leaf(uint triangle) { return uint(triangle_vertices[3u * triangle + 1u].w); }

bool emitter_is_hidden_from_media(EmitterNumber triangle) {
    return (emitter_traits(triangle) & EMITTER_HIDDEN_FROM_MEDIA) != 0u;
}

// The light sets of a triangle that emits (common/light_sets.glsl).
float emitter_set_code(EmitterNumber triangle) { return triangle_vertices[3u * triangle].w; }

EmissiveTriangle read_emitter(EmitterNumber emitter, out EmitterNumber triangle, out vec3 v0, out vec3 v1,
                              out vec3 v2) {
    EmissiveTriangle emissive = emissive_triangles[emitter];
    triangle_corners(emissive.triangle, v0, v1, v2);
    triangle = emissive.triangle;
    return emissive;
}

uint search_emissive_triangle(float u) {
    uint low = 0u, high = uint(iteration.emissive_triangle_count) - 1u;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (emissive_triangles[middle].cumulated > u) high = middle;
        else low = middle + 1u;
    }
    return low;
}

// By its probability. place: more random numbers, where u has too few bits.
EmitterNumber choose_emitter(float u, vec2 place, out float probability) {
    uint index = search_emissive_triangle(u);
    probability = emissive_triangles[index].probability;
    return index;
}

#include "lights/triangle_point.glsl"

TrianglePoint sample_emissive_triangle(float u_triangle, vec2 u) {
    uint index = search_emissive_triangle(u_triangle);
    EmissiveTriangle emissive = emissive_triangles[index];
    vec3 v0, v1, v2;
    triangle_corners(emissive.triangle, v0, v1, v2);
    float root = sqrt(u.x);
    vec3 position = (1.0 - root) * v0 + root * (1.0 - u.y) * v1 + root * u.y * v2;
    vec3 normal = normalize(cross(v1 - v0, v2 - v0));
    return TrianglePoint(position, normal, emissive.triangle, sampled_radiance(emissive),
                         emissive.probability / max(emissive.area, 1e-30), ray_offset(normal, v0, v1, v2));
}
