// SPDX-License-Identifier: GPL-3.0-or-later
// A sample of the BSDF at a vertex of a photon path. The includer includes photons/parts.glsl and
// photons/photon_vertex.glsl before.

#include "common/path_history.glsl"
#include "common/random.glsl"

struct BsdfSample {
    vec3 direction;
    vec3 weight;  // of the flux; 0 where the photon is absorbed
    vec3 normal;  // of the lobe
    bool transmitted;
    uint flags;           // that the path gets
    uint exclusion_flag;  // of direct photons from lights that do not take part in such scattering
    uint scatter;         // Scatter of the part
    uint part;            // of the closure
    float ior;
};

// Lobes up to roughness 0.22 cast caustics. Light that rougher ones scatter is as soft as diffuse light.
const float MAX_CAUSTIC_ALPHA = 0.05;

// Where normals differ from that of the surface, grazing light may count for much; this limits by how much. Each limit
// loses light: one of 4 lost a fiftieth of the picture of a glass whose rim is shaded smooth.
const float MAX_NORMAL_CORRECTION = 64.0;

// Fractions of the flux that the parts of a closure scatter. Their sum may exceed 1.
struct FluxFractions {
    float diffuse;
    float translucent;
    float transparent;
    vec3 lobes;
};

FluxFractions flux_fractions(PhotonVertex vertex) {
    vec3 flux = vertex.flux;
    Closure closure = vertex.closure;
    float scale = 1.0 / largest(flux);
    FluxFractions fractions =
        FluxFractions(largest(flux * closure.diffuse) * scale, largest(flux * closure.translucent) * scale,
                      largest(flux * closure.transparent) * scale, vec3(0.0));
    for (int k = 0; k < closure_lobes(closure); ++k) {
        MicrofacetLobe lobe = stored_lobe(vertex.index, k);
        fractions.lobes[k] = largest(flux * lobe_albedo(lobe, lobe_cosine(lobe, vertex.wo))) * scale;
    }
    if ((closure.flags & CLOSURE_KEEPS_LIGHT) != 0u) {
        fractions.diffuse = fractions.translucent = 0.0;
        fractions.lobes = vec3(0.0);
    }
    return fractions;
}

// Fibers transmit what leaves them behind the surface. Huang's hair gets light straight from lights by shadow rays in
// Cycles, and little of it by paths: where those rays bring none, photons bring none either.
LobeSample fiber_sample(LobeSample sampled, MicrofacetLobe lobe, PhotonVertex vertex) {
    vec3 viewer = sampled.direction;
    sampled.transmitted = dot(viewer, unpack_unit_vector(vertex.closure.geometric_normal)) < 0.0;
#ifdef HAIR_LOBES
    bool is_from_light = (vertex.flags & PHOTON_CASTS_SHADOWS) != 0u;
    if (is_from_light && lobe.kind == LOBE_HAIR_HUANG && is_hidden(lobe, lobe_normal(lobe), viewer, vertex.wo))
        sampled.weight = vec3(0.0);
#endif
    return sampled;
}

// By a lobe. The weight is divided by the probability of the lobe, which is its fraction over the sum of all.
BsdfSample sample_selected_lobe(PhotonVertex vertex, int selected, float fraction, float sum, vec2 disk, float uc) {
    Closure closure = vertex.closure;
    MicrofacetLobe lobe = stored_lobe(vertex.index, selected);
    LobeSample sampled = sample_lobe(lobe, lobe_normal(lobe), vertex.wo, disk, uc, false);
    float shadowing = lobe_shadowing(lobe, closure.shading_normal, sampled.direction);
    if (lobe_is_hair(lobe.kind)) sampled = fiber_sample(sampled, lobe, vertex);
    uint flags = (lobe.alpha <= MAX_CAUSTIC_ALPHA ? 0u : PHOTON_AFTER_ROUGH_BOUNCE)
                 | (lobe_stores(lobe, iteration.specular_alpha) ? PHOTON_INDIRECT : 0u)
                 | dispersed_flag(closure, lobe, sampled.transmitted);
    BsdfSample bsdf =
        BsdfSample(sampled.direction, sampled.weight * (shadowing * sum / max(fraction, 1e-20)), lobe_normal(lobe),
                   sampled.transmitted, flags, sampled.transmitted ? PHOTON_NOT_TRANSMITTED : PHOTON_NOT_GLOSSY,
                   lobe_scatter(lobe.kind, sampled.transmitted), lobe_part(lobe, sampled.transmitted), lobe.ior);
    if (bsdf.part == PART_STRAND) bsdf.normal = unpack_unit_vector(closure.geometric_normal);
    return bsdf;
}

// Viewers of all directions see a diffuse surface alike, so that photons leave it by the cosine to the surface itself;
// the shading normal weights the flux that arrives.
BsdfSample sample_diffuse(PhotonVertex vertex, bool reflected, vec2 disk) {
    Closure closure = vertex.closure;
    vec3 geometric = unpack_unit_vector(closure.geometric_normal), normal = unpack_unit_vector(closure.diffuse_normal);
    float correction =
        min(max(dot(normal, vertex.wo), 0.0) / max(dot(geometric, vertex.wo), 1e-6), MAX_NORMAL_CORRECTION);
    if (!reflected) {
        geometric = -geometric;
        normal = -normal;
    }
    uint part = reflected ? PART_DIFFUSE : PART_TRANSLUCENT;
    vec3 direction = cosine_hemisphere(geometric, disk);
    return BsdfSample(direction, correction * diffuse_bsdf(closure, part, normal, direction, vertex.wo), geometric,
                      !reflected, PHOTON_AFTER_ROUGH_BOUNCE | PHOTON_INDIRECT, PHOTON_NOT_DIFFUSE, SCATTER_DIFFUSE,
                      part, 1.0);
}

// One part of the closure is selected by its fraction of the flux; the rest of the probability is absorption. Lobes
// come first in the code because they need most registers: values of the other branches would be kept beside them.
BsdfSample sample_bsdf(PhotonVertex vertex, inout RandomSequence random) {
    FluxFractions fractions = flux_fractions(vertex);
    float diffuse = fractions.diffuse, translucent = fractions.translucent, transparent = fractions.transparent;
    vec3 lobes = fractions.lobes;
    float scattered = diffuse + transparent + lobes.x + lobes.y + lobes.z + translucent;
    float sum = max(scattered, 1.0);
    float u = next_random(random) * sum;
    vec2 disk = sample_disk(next_random2(random));
    float uc = next_random(random);
    BsdfSample bsdf;
    bsdf.weight = vec3(0.0);
    if (u >= scattered) return bsdf;
    bool reflected = u < diffuse;
    if (!reflected) u -= diffuse;
    bool is_diffuse = reflected || u < translucent;
    u -= translucent;
    bool is_transparent = !is_diffuse && u < transparent;
    u -= transparent;
    if (!is_diffuse && !is_transparent) {
        int selected = u < lobes.x ? 0 : (u < lobes.x + lobes.y ? 1 : 2);
        bsdf = sample_selected_lobe(vertex, selected, lobes[selected], sum, disk, uc);
    } else if (is_transparent)
        bsdf = BsdfSample(-vertex.wo, vertex.closure.transparent * (sum / transparent), vertex.wo, true, 0u, 0u,
                          SCATTER_NONE, PART_TRANSPARENT, 1.0);
    else {
        bsdf = sample_diffuse(vertex, reflected, disk);
        bsdf.weight *= sum / (reflected ? diffuse : translucent);
    }
    return bsdf;
}
