// SPDX-License-Identifier: GPL-3.0-or-later
// Ray portals. Before the nodes of a material that has them (rppm_addon/materials/traits/ray_portals.py), behind
// subsurface scattering.

#include "common/finite.glsl"
#include "materials/builder.glsl"
#include "common/bsdf/ray_portal.glsl"
#define MATERIAL_RAY_PORTAL

// What nodes have added so far, and what the closure gets when all have. The position is that of nodes.
RayPortal material_ray_portal = NO_RAY_PORTAL;

// As in Cycles, places so near to each other are the same one, m^2.
const float SAME_PLACE = 1e-9;

// Of several, one is chosen by its weight and stands for all. A null direction is that of the path that comes there.
void add_ray_portal(inout ClosureBuilder builder, vec3 weight, vec3 position, vec3 direction) {
    float brightness = largest(weight), held = largest(material_ray_portal.weight);
    if (!(brightness > 0.0)) return;
    float probability = brightness / (brightness + held);
    if (!chance(builder, probability)) {
        material_ray_portal.weight /= 1.0 - probability;
        return;
    }
    float size = length(direction);
    material_ray_portal =
        RayPortal(weight / probability, position, size > 0.0 ? direction / size : -builder.viewer, false);
}

// Whether the ray portal is chosen in place of another part, by the albedos of both. Its weight then stands for both.
bool takes_place(inout ClosureBuilder builder, float others) {
    float brightness = largest(material_ray_portal.weight), probability = brightness / (brightness + others);
    bool chosen = chance(builder, probability);
    material_ray_portal.weight *= chosen ? 1.0 / probability : 0.0;
    return chosen;
}

// A closure of three lobes has no place for it: then it or the last lobe is chosen by its albedo, and likewise it or
// what goes below the surface.
void hold_ray_portal(Surface surface, inout ClosureBuilder builder) {
    if (!(largest(material_ray_portal.weight) > 0.0)) return;
#ifdef MATERIAL_SUBSURFACE
    float below = largest(material_subsurface.weight);
    if (below > 0.0) {
        float portal = largest(material_ray_portal.weight);
        if (!takes_place(builder, below)) {
            material_subsurface.weight *= (below + portal) / below;
            return;
        }
        material_subsurface.weight = vec3(0.0);
    }
#endif
    if (builder.lobes == CLOSURE_LOBES) {
        MicrofacetLobe last = last_lobe(builder.closure);
        float others = largest(lobe_albedo(last, lobe_cosine(last, builder.viewer))),
              portal = largest(material_ray_portal.weight);
        if (!takes_place(builder, others)) {
            scale_lobe(last, (others + portal) / max(others, 1e-20));
            hold_lobe(builder, CLOSURE_LOBES - 1, last);
            return;
        }
        builder.lobes -= 1;
    }
    vec3 way = material_ray_portal.position - world_position(surface);
    bool moves = is_finite(way) && dot(way, way) > SAME_PLACE;
    material_ray_portal.moves = moves;
    material_ray_portal.position = surface.position + (moves ? way : vec3(0.0));
    if (!is_finite(material_ray_portal.direction)) material_ray_portal.direction = -builder.viewer;
    builder.closure.lobes[CLOSURE_LOBES - 1] = packed_ray_portal(material_ray_portal);
}
