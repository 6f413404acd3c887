// SPDX-License-Identifier: GPL-3.0-or-later
// The ray by which a photon path goes on. The includer includes photons/sample_bsdf.glsl before.

// Takes the parts out of a closure that a limit forbids: behind the last bounce all but transparency, and behind the
// last transparent surface transparency. Returns whether any part is left.
bool limit_bounces(inout Closure closure, uint depth) {
    if (!may_pass(closure, depth, iteration.transparent_max_bounces)) closure.transparent = vec3(0.0);
    if (bounces_of(depth) < iteration.photon_bounces) return true;
    closure.flags |= CLOSURE_KEEPS_LIGHT;
    return largest(closure.transparent) > 0.0;
}

// Shading normals make scattering asymmetric; this is the factor for particles (Veach 1997, eq. 5.19). The weights of
// diffuse samples have it already, since their normal is that of the surface.
float adjoint_correction(vec3 wo, vec3 wi, vec3 geometric, vec3 shading) {
    float above = abs(dot(wo, shading)) * abs(dot(wi, geometric));
    float below = abs(dot(wo, geometric)) * abs(dot(wi, shading));
    return min(above / max(below, 1e-6), MAX_NORMAL_CORRECTION);
}

// The ray is turned to look back from where the photon goes, and waits where the BSDF does not depend on the view
// (adjoint.comp). Nor is it evaluated from there where one part of a closure stands for others: the query then holds
// the part alone, for photons that go below the surface. flags: of the path from here on.
void store_adjoint_query(PhotonVertex vertex, BsdfSample bsdf, uint flags, float maximum_distance) {
    uint index = vertex.index;
    Closure closure = vertex.closure;
    bool depends_on_view = materials[closure.material].depends_on_view != 0u && (closure.flags & CLOSURE_CROWDED) == 0u;
    AdjointQuery query = AdjointQuery(vec3(0.0), PART_NONE, bsdf.ior, flags, maximum_distance, 0u);
    if (depends_on_view) {
        query.part = bsdf.part;
        vec3 normal = unpack_unit_vector(closure.diffuse_normal);
        if (bsdf.part == PART_DIFFUSE || bsdf.part == PART_TRANSLUCENT)
            query.bsdf =
                diffuse_bsdf(closure, bsdf.part, bsdf.transmitted ? -normal : normal, bsdf.direction, vertex.wo);
        else query.bsdf = part_bsdf(index, closure, bsdf.part, bsdf.ior, vertex.wo, bsdf.direction);
    } else {
        photon_paths[index].flags = flags;
        if ((closure.flags & CLOSURE_SUBSURFACE) != 0u) query.part = bsdf.part;
    }
    adjoint_queries[index] = query;
    rays[index].direction = -bsdf.direction;
    rays[index].maximum_distance = depends_on_view ? INFINITY_DISTANCE : 0.0;
}

// The differential of a direction that a smooth surface reflects or refracts; ratio: of the indices.
vec3 scattered_turn(vec3 turn, vec3 turned_normal, vec3 arriving, BsdfSample bsdf, float ratio) {
    return bsdf.transmitted ? refracted_turn(turn, turned_normal, arriving, bsdf.direction, bsdf.normal, ratio)
                            : mirrored_turn(turn, turned_normal, arriving, bsdf.normal);
}

// Scattering changes the directions of a ray differential, which are read from memory again. Rough surfaces end it, and
// transparency does not change it.
void scatter_differential(PhotonVertex vertex, BsdfSample bsdf) {
    uint index = vertex.index;
    if ((bsdf.flags & PHOTON_AFTER_ROUGH_BOUNCE) != 0u) photon_differentials[index].known = 0u;
    else if (bsdf.part != PART_TRANSPARENT) {
        NormalChange change = normal_change(vertex.closure.triangle, vertex.closure.position, bsdf.normal);
        float ratio = 1.0 / bsdf.ior;
        vec3 turn = photon_differentials[index].turn_u;
        vec3 turned_normal = normal_turn(change, photon_differentials[index].place_u);
        photon_differentials[index].turn_u = scattered_turn(turn, turned_normal, -vertex.wo, bsdf, ratio);
        turn = photon_differentials[index].turn_v;
        turned_normal = normal_turn(change, photon_differentials[index].place_v);
        photon_differentials[index].turn_v = scattered_turn(turn, turned_normal, -vertex.wo, bsdf, ratio);
    }
}

// The flags of a path behind a vertex.
uint departing_flags(PhotonVertex vertex, BsdfSample bsdf, bool straight) {
    uint flags = vertex.flags | bsdf.flags;
    if (!straight)
        flags = scattered_flags(flags, bsdf.scatter == SCATTER_DIFFUSE)
                & ~(PHOTON_NOT_DIFFUSE | PHOTON_NOT_GLOSSY | PHOTON_NOT_TRANSMITTED | PHOTON_CASTS_SHADOWS);
    if (!straight || (vertex.closure.flags & CLOSURE_SHADOWLESS) == 0u) flags &= ~PHOTON_DIRECT;
    if (bsdf.transmitted) flags = cross_surface(flags, vertex.closure.material, closure_backfacing(vertex.closure));
    return flags;
}

#ifdef COUNTS_BOUNCES
#include "common/bounce_limits.glsl"

// The counts of a path behind a vertex. The surface that light comes to first does not count: a camera path ends there.
uint departing_counts(PhotonVertex vertex, BsdfSample bsdf) {
    if (bsdf.scatter == SCATTER_NONE || bounces_of(vertex.depth) == 0u) return vertex.bounce_counts;
    return counted(vertex.bounce_counts, counted_scatter(bsdf.scatter, bsdf.transmitted));
}
#endif

#ifdef DROPS_CAUSTICS
#include <CausticKinds>

// The kind of caustic that a sample makes of a photon where it comes to a diffuse surface next. Fibers make none.
uint caustic_kind(BsdfSample bsdf) {
    if (bsdf.part == PART_HAIR || bsdf.part == PART_STRAND) return 0u;
    if (bsdf.scatter == SCATTER_TRANSMISSION) return CAUSTIC_REFRACTED;
    return bsdf.scatter == SCATTER_GLOSSY ? CAUSTIC_REFLECTED : 0u;
}
#endif

// Writes the next ray and the state of the path.
void spawn_ray(PhotonVertex vertex, BsdfSample bsdf, bool straight) {
    uint index = vertex.index;
    Closure closure = vertex.closure;
    vec3 geometric = unpack_unit_vector(closure.geometric_normal);
    if (bsdf.part != PART_TRANSPARENT) photon_paths[index].depth += ONE_BOUNCE;
    else if (counts_as_transparent(closure)) photon_paths[index].depth += ONE_TRANSPARENT;
#ifdef DROPS_CAUSTICS
    if (bsdf.part != PART_TRANSPARENT)
        photon_paths[index].depth = (photon_paths[index].depth & DEPTH_MASK) | caustic_kind(bsdf) << CAUSTIC_SHIFT;
#endif
    if (vertex.has_differential) scatter_differential(vertex, bsdf);
    if (!straight) photon_differentials[index].before = 0.0;
    float offset = closures[index].ray_offset;
    vec3 origin = closure.position + (dot(bsdf.direction, geometric) > 0.0 ? offset : -offset) * geometric;
    float maximum_distance = straight ? max(vertex.remaining_distance, ESCAPING_DISTANCE) : INFINITY_DISTANCE;
    rays[index] = Ray(origin, closure.triangle, bsdf.direction, maximum_distance);
    uint flags = departing_flags(vertex, bsdf, straight);
    if (parameters.has_adjoint_queries != 0u) store_adjoint_query(vertex, bsdf, flags, maximum_distance);
    else photon_paths[index].flags = flags;
}

// The path ends where the photon is absorbed or would leave on the wrong side of the surface.
void sample_next_ray(PhotonVertex vertex) {
    vec3 geometric = unpack_unit_vector(vertex.closure.geometric_normal);
    RandomSequence random =
        random_sequence(iteration.seed, iteration.number, STAGE_PHOTONS, parameters.segment, vertex.index);
    BsdfSample bsdf = sample_bsdf(vertex, random);
    float side = dot(bsdf.direction, geometric);
    bool leaves = bsdf.transmitted ? side < 0.0 : side > 0.0;
    if (!(largest(bsdf.weight) > 0.0 && leaves)) return;
    bool straight = bsdf.direction == -vertex.wo;
#ifdef DROPS_CAUSTICS
    bool is_caustic = (vertex.depth >> CAUSTIC_SHIFT & iteration.dropped_caustics) != 0u;
    if (is_caustic && bsdf.scatter == SCATTER_DIFFUSE) return;
#endif
#ifdef COUNTS_BOUNCES
    uint counts = departing_counts(vertex, bsdf);
    if (exceed_limits(counts_of(counts))) return;
    photon_paths[vertex.index].bounce_counts = counts;
#endif
    if (!straight) bsdf.weight *= adjoint_correction(vertex.wo, bsdf.direction, geometric, bsdf.normal);
    bool is_excluded = ((vertex.flags | bsdf.flags) & bsdf.exclusion_flag) != 0u;
    photon_paths[vertex.index].flux = is_excluded ? vec3(0.0) : vertex.flux * bsdf.weight;
    spawn_ray(vertex, bsdf, straight);
}
