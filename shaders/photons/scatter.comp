#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint:
// lint: HAIR_LOBES=1
// lint: ASHIKHMIN_LOBES=1
// TracePhotons: store the photon and choose how its path goes on (D, G or S by importance).

layout(local_size_x = 64) in;

#include <ScatterPhotonsParameters>
#include "common/iteration.glsl"
#include "common/active_paths.glsl"
#include "common/random.glsl"
#include "common/photon.glsl"
uniform Parameters { ScatterPhotonsParameters parameters; };
readonly buffer Closures;
#include "photons/parts.glsl"
#include "common/transparency.glsl"
readonly buffer Materials;
#include "materials/medium.glsl"
buffer Rays;
buffer PhotonPaths;
writeonly buffer Photons;
writeonly buffer AdjointQueries;
readonly buffer PhotonRange;
#include "photons/differentials.glsl"

// unseen: a flag of direct photons from lights that do not take part in such events.
struct Scattering {
    vec3 direction;
    vec3 weight;
    vec3 normal;
    bool transmitted;
    uint flags;
    uint unseen;
    bool diffuse;
    uint part;
    float ior;
};

// Lobes up to roughness 0.22 draw caustics; what rougher ones scatter is as soft as diffuse light.
const float SHARPEST_ALPHA = 0.05;

// Where normals differ from the surface's, light that only grazes it may count for much: as many times at most.
const float MOST_BY_NORMALS = 4.0;

const float NO_REACH = 1e-30;  // of a ray that goes on and meets nothing

// from_light: at once, and not from the world. Huang's hair gets such light by shadow rays in Cycles, and little of
// it by paths: where those see none, none comes.
LobeSample of_fiber(LobeSample sampled, MicrofacetLobe lobe, vec3 geometric, vec3 arrival, bool from_light) {
    vec3 viewer = sampled.direction;
    sampled.transmitted = dot(viewer, geometric) < 0.0;
#ifdef HAIR_LOBES
    if (from_light && lobe.kind == LOBE_HAIR_HUANG && is_hidden(lobe, lobe_normal(lobe), viewer, arrival))
        sampled.weight = vec3(0.0);
#endif
    return sampled;
}

// Viewers of all directions see a diffuse surface alike, so that photons leave it by the cosine to the surface itself;
// the shading normal says how much of the light counts.
Scattering scatter_diffuse(Closure closure, bool reflected, vec3 arrival, vec2 disk) {
    vec3 geometric = unpack_unit_vector(closure.geometric_normal), normal = unpack_unit_vector(closure.diffuse_normal);
    float counts = min(max(dot(normal, arrival), 0.0) / max(dot(geometric, arrival), 1e-6), MOST_BY_NORMALS);
    if (!reflected) {
        geometric = -geometric;
        normal = -normal;
    }
    uint part = reflected ? PART_DIFFUSE : PART_TRANSLUCENT;
    vec3 direction = cosine_hemisphere(geometric, disk);
    return Scattering(direction, counts * diffuse_bsdf(closure, part, normal, direction, arrival), geometric,
                      !reflected, PHOTON_AFTER_ROUGH_BOUNCE | PHOTON_INDIRECT, PHOTON_NOT_DIFFUSE, true, part, 1.0);
}

float total(vec3 flux) { return flux.x + flux.y + flux.z; }

// Takes out of a closure what a limit forbids: all but transparency behind the last bounce, and transparency behind
// the last such surface. Whether anything is left.
bool may_go_on(inout Closure closure, uint depth) {
    if (transparents_of(depth) >= iteration.transparent_max_bounces && counts_as_transparent(closure))
        closure.transparent = vec3(0.0);
    if (bounces_of(depth) < iteration.photon_bounces) return true;
    closure.flags |= CLOSURE_KEEPS_LIGHT;
    return largest(closure.transparent) > 0.0;
}

// One event by its share of the flux; what is left of the probability is absorption.
Scattering scatter(uint index, Closure closure, vec3 flux, vec3 arrival, bool from_light, inout RandomSequence random) {
    float scale = 1.0 / largest(flux);
    float diffuse = largest(flux * closure.diffuse) * scale, translucent = largest(flux * closure.translucent) * scale,
          transparent = largest(flux * closure.transparent) * scale;
    vec3 shares = vec3(0.0);
    for (int k = 0; k < closure_lobes(closure); ++k) {
        MicrofacetLobe lobe = stored_lobe(index, k);
        shares[k] = largest(flux * lobe_albedo(lobe, lobe_cosine(lobe, arrival))) * scale;
    }
    if ((closure.flags & CLOSURE_KEEPS_LIGHT) != 0u) diffuse = translucent = shares.x = shares.y = shares.z = 0.0;
    float total = diffuse + transparent + shares.x + shares.y + shares.z + translucent;
    float norm = max(total, 1.0);
    float u = next_random(random) * norm;
    vec2 disk = sample_disk(next_random2(random));
    float uc = next_random(random);
    Scattering result;
    result.weight = vec3(0.0);
    if (u >= total) return result;
    bool reflected = u < diffuse;
    if (!reflected) u -= diffuse;
    bool is_diffuse = reflected || u < translucent;
    u -= translucent;
    bool is_transparent = !is_diffuse && u < transparent;
    u -= transparent;
    // Lobes first, since they need most registers: what else there is to choose from would be kept beside.
    if (!is_diffuse && !is_transparent) {
        int chosen = u < shares.x ? 0 : (u < shares.x + shares.y ? 1 : 2);
        float probability = shares[chosen];
        MicrofacetLobe lobe = stored_lobe(index, chosen);
        vec3 geometric = unpack_unit_vector(closure.geometric_normal);
        LobeSample sampled = sample_lobe(lobe, lobe_normal(lobe), arrival, disk, uc, false);
        float shadowing = lobe_shadowing(lobe, closure.shading_normal, sampled.direction);
        if (lobe_is_hair(lobe.kind)) sampled = of_fiber(sampled, lobe, geometric, arrival, from_light);
        result = Scattering(sampled.direction, sampled.weight * (shadowing * norm / max(probability, 1e-20)),
                            lobe_normal(lobe), sampled.transmitted,
                            (lobe.alpha <= SHARPEST_ALPHA ? 0u : PHOTON_AFTER_ROUGH_BOUNCE)
                                | (lobe_stores(lobe, iteration.specular_alpha) ? PHOTON_INDIRECT : 0u)
                                | dispersed_flag(closure, lobe, sampled.transmitted),
                            sampled.transmitted ? PHOTON_NOT_TRANSMITTED : PHOTON_NOT_GLOSSY,
                            lobe_is_diffuse(lobe.kind), lobe_part(lobe, sampled.transmitted), lobe.ior);
        if (result.part == PART_STRAND) result.normal = geometric;
    } else if (is_transparent)
        result = Scattering(-arrival, closure.transparent * (norm / transparent), arrival, true, 0u, 0u, false,
                            PART_TRANSPARENT, 1.0);
    else {
        result = scatter_diffuse(closure, reflected, arrival, disk);
        result.weight *= norm / (reflected ? diffuse : translucent);
    }
    return result;
}

// Diffuse surfaces make caustics of what lobes that are not sent there.
uint scattered_flags(uint path_flags, bool diffuse) {
    const uint by_lobe = PHOTON_SCATTERED_BY_LOBE >> PHOTON_HISTORY_SHIFT;
    if (!diffuse) return path_flags | by_lobe;
    bool caustic = (path_flags & by_lobe) != 0u;
    return (path_flags & ~by_lobe) | (caustic ? PHOTON_CAUSTIC >> PHOTON_HISTORY_SHIFT : 0u);
}

// Those of a path as a photon has them.
uint photon_flags(uint path_flags) {
    const uint history = PHOTON_SCATTERED_BY_LOBE | PHOTON_CAUSTIC;
    return (path_flags & PHOTON_FLAG_MASK & ~(history | history >> PHOTON_HISTORY_SHIFT))
           | ((path_flags << PHOTON_HISTORY_SHIFT) & history);
}

// Shading normals make scattering asymmetric: what Veach (1997, eq. 5.19) gives for particles. Diffuse ones have it
// already.
float adjoint_correction(vec3 arrival, vec3 departure, vec3 geometric, vec3 shading) {
    float above = abs(dot(arrival, shading)) * abs(dot(departure, geometric));
    float below = abs(dot(arrival, geometric)) * abs(dot(departure, shading));
    return min(above / max(below, 1e-6), MOST_BY_NORMALS);
}

// The ray is turned to look from where the photon goes, and waits where that does not matter (adjoint.comp). Of a
// closure where one part stands for others, the view from there is no measure: the query then tells the part alone, for
// those that go below the surface.
void store_adjoint_query(uint index, Closure closure, Scattering scattering, vec3 arrival, uint path_flags,
                         float reach) {
    bool matters = materials[closure.material].depends_on_view != 0u && (closure.flags & CLOSURE_CROWDED) == 0u;
    AdjointQuery query = AdjointQuery(vec3(0.0), PART_NONE, scattering.ior, path_flags, reach, 0u);
    if (matters) {
        query.part = scattering.part;
        vec3 normal = unpack_unit_vector(closure.diffuse_normal);
        if (scattering.part == PART_DIFFUSE || scattering.part == PART_TRANSLUCENT)
            query.bsdf = diffuse_bsdf(closure, scattering.part, scattering.transmitted ? -normal : normal,
                                      scattering.direction, arrival);
        else query.bsdf = part_bsdf(index, closure, scattering.part, scattering.ior, arrival, scattering.direction);
    } else {
        photon_paths[index].flags = path_flags;
        if ((closure.flags & CLOSURE_SUBSURFACE) != 0u) query.part = scattering.part;
    }
    adjoint_queries[index] = query;
    rays[index].direction = -scattering.direction;
    rays[index].maximum_distance = matters ? INFINITY_DISTANCE : 0.0;
}

// What is known of a path's neighbors where it hits a surface goes to memory, and what scattering changes of it is
// read again: rough surfaces end it, transparency changes nothing of it.
void scatter_differential(uint index, Closure closure, Scattering scattering, vec3 arriving) {
    if ((scattering.flags & PHOTON_AFTER_ROUGH_BOUNCE) != 0u) photon_differentials[index].known = 0u;
    else if (scattering.part != PART_TRANSPARENT) {
        vec3 normal = scattering.normal, leaving = scattering.direction;
        NormalChange change = normal_change(closure.triangle, closure.position, normal);
        float ratio = 1.0 / scattering.ior;
        vec3 turn = photon_differentials[index].turn_u,
             turned = normal_turn(change, photon_differentials[index].place_u);
        photon_differentials[index].turn_u = scattering.transmitted
                                                 ? refracted_turn(turn, turned, arriving, leaving, normal, ratio)
                                                 : mirrored_turn(turn, turned, arriving, normal);
        turn = photon_differentials[index].turn_v;
        turned = normal_turn(change, photon_differentials[index].place_v);
        photon_differentials[index].turn_v = scattering.transmitted
                                                 ? refracted_turn(turn, turned, arriving, leaving, normal, ratio)
                                                 : mirrored_turn(turn, turned, arriving, normal);
    }
}

// The ray and the flux that a path goes on with, if it does; path_flags are those that it came with. counts: whether a
// limit counts where it goes straight on; left: how far the ray would have gone then.
void sample_next_ray(uint index, Closure closure, uint path_flags, bool counts, bool neighbors_known, vec3 arrival,
                     vec3 flux, float left) {
    vec3 geometric = unpack_unit_vector(closure.geometric_normal);
    RandomSequence random = random_sequence(iteration.seed, iteration.number, STAGE_PHOTONS, parameters.segment, index);
    bool from_light = (path_flags & PHOTON_CASTS_SHADOWS) != 0u;
    Scattering scattering = scatter(index, closure, flux, arrival, from_light, random);
    float side = dot(scattering.direction, geometric);
    bool passes = scattering.transmitted ? side < 0.0 : side > 0.0;
    if (!(largest(scattering.weight) > 0.0 && passes)) return;
    bool straight = scattering.direction == -arrival;
    if (!straight) scattering.weight *= adjoint_correction(arrival, scattering.direction, geometric, scattering.normal);
    flux *= scattering.weight;
    path_flags |= scattering.flags;
    if ((path_flags & scattering.unseen) != 0u) flux = vec3(0.0);
    photon_paths[index].flux = flux;
    if (scattering.part != PART_TRANSPARENT) photon_paths[index].depth += ONE_BOUNCE;
    else if (counts) photon_paths[index].depth += ONE_TRANSPARENT;
    if (!straight)
        path_flags = scattered_flags(path_flags, scattering.diffuse)
                     & ~(PHOTON_NOT_DIFFUSE | PHOTON_NOT_GLOSSY | PHOTON_NOT_TRANSMITTED | PHOTON_CASTS_SHADOWS);
    if (!straight || (closure.flags & CLOSURE_SHADOWLESS) == 0u) path_flags &= ~PHOTON_DIRECT;
    if (neighbors_known) scatter_differential(index, closure, scattering, -arrival);
    if (!straight) photon_differentials[index].before = 0.0;
    if (scattering.transmitted) path_flags = cross_surface(path_flags, closure.material, closure_backfacing(closure));
    float offset = closures[index].ray_offset;
    vec3 origin = closure.position + (side > 0.0 ? offset : -offset) * geometric;
    float reach = straight ? max(left, NO_REACH) : INFINITY_DISTANCE;
    rays[index] = Ray(origin, closure.triangle, scattering.direction, reach);
    if (parameters.has_adjoint_queries != 0u)
        store_adjoint_query(index, closure, scattering, arrival, path_flags, reach);
    else photon_paths[index].flags = path_flags;
}

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    uint slot = photon_first + active_place(), number = index | parameters.segment << PHOTON_SEGMENT_SHIFT;
    vec3 carried = photon_paths[index].flux;
    Ray ray = rays[index];
    rays[index].maximum_distance = 0.0;
    photon_paths[index].flux = vec3(0.0);
    uint path_flags = photon_paths[index].flags, depth = photon_paths[index].depth;
    if (!(largest(carried) > 0.0)) {
        photons[slot] = Photon(vec3(0.0), 0u, carried, 0u, -ray.direction, 0.0, number, depth, 0u, 0u);
        return;
    }
    uint flags = PHOTON_ACTIVE | photon_flags(path_flags);
    vec3 arrival = -ray.direction;
    Closure closure = closures[index];
    if (!closure_hit(closure)) {
        photons[slot] =
            Photon(vec3(0.0), flags | PHOTON_ESCAPED, carried, 0u, arrival, INFINITY_DISTANCE, number, depth, 0u, 0u);
        photon_paths[index].escaped = total(carried);
        return;
    }
    vec3 flux = carried * segment_transmittance(path_flags, closure.distance);
    bool counts = counts_as_transparent(closure), ends = !(largest(flux) > 0.0);
    PhotonDifferential differential = photon_differentials[index];
    bool neighbors_known = differential.known != 0u;
    if (neighbors_known) {
        differential = moved_to_hit(differential, ray.direction, closure.distance,
                                    unpack_unit_vector(closure.geometric_normal), parameters.segment == 0u);
        flags |= packed_footprint(differential);
        if (!ends) photon_differentials[index] = differential;
    }
    bool stores = largest(closure.diffuse + closure.translucent) > 0.0;
    for (int k = 0; k < closure_lobes(closure); ++k)
        stores = stores || lobe_stores(stored_lobe(index, k), iteration.specular_alpha);
    if (stores && (path_flags & PHOTON_NOT_DIFFUSE) == 0u) flags |= PHOTON_STORED;
    // Written before the path goes on: what it needs of registers then is more.
    float away = differential.before + closure.distance;
    photons[slot] =
        Photon(closure.position, flags, flux, closure.geometric_normal, arrival, away, number, depth, 0u, 0u);
    photon_differentials[index].before = away;
    if (ends) return;
    float left = ray.maximum_distance - closure.distance;
    if (may_go_on(closure, depth))
        sample_next_ray(index, closure, path_flags, counts, neighbors_known, arrival, flux, left);
    else photon_paths[index].deposited = total(carried);
}
