// SPDX-License-Identifier: GPL-3.0-or-later
// Traits of emissive triangles, some of which are those of instances. Needs the storage block Triangles.
#include "lights/emissive_triangles.glsl"
#include "common/constants.glsl"
#include <EmitterTraits>
#include "lights/two_levels/instances.glsl"

// A number of an emissive triangle, of a triangle that emits, or of a leaf of the light tree: the instance that it is
// of, by its place in EmitterInstances, or NO_TRIANGLE; and the number within its mesh, or in the world.
#define EmitterNumber uvec2
const EmitterNumber NO_EMITTER = uvec2(NO_TRIANGLE);

EmitterNumber in_world(uint number) { return uvec2(NO_TRIANGLE, number); }
bool is_of_instance(EmitterNumber emitter) { return emitter.x != NO_TRIANGLE; }

// A triangle that a ray has hit, as emitters are numbered: gather_hits.comp says which one a hit triangle is.
EmitterNumber hit_emitter(uint triangle) {
    if (triangle == NO_TRIANGLE || triangle < emitter_levels().first_hit_triangle) return in_world(triangle);
    return uvec2(triangle_vertices[3u * triangle + 2u].w, triangle_vertices[3u * triangle + 1u].w);
}

// 0 of a triangle that does not emit.
uint emitter_traits(uint triangle) {
    EmitterNumber emitter = hit_emitter(triangle);
    if (!is_of_instance(emitter)) return uint(triangle_vertices[3u * triangle + 2u].w);
    EmitterInstance instance = emitter_instance(emitter.x);
    if (instance.leaves == 0u) return 0u;
    EmissiveTriangle emissive = emissive_triangles[instance.first_emitter + emitter.y];
    return emissive.probability > 0.0 ? emissive.traits | instance.traits : 0u;
}
