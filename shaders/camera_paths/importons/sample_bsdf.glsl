// SPDX-License-Identifier: GPL-3.0-or-later
// A sample of the BSDF at a vertex of a camera path.
// The includer includes camera_paths/importons/path_vertex.glsl before.

struct BsdfSample {
    vec3 direction;
    vec3 weight;        // BSDF times cosine over the pdf of the direction, given the lobe
    vec3 normal;        // of the lobe; where it is diffuse, on the side of the direction
    float probability;  // selection weight of the lobe, out of the total of the LobeSelection
    bool transmitted;
    float pdf;               // of the direction, 1/sr, where shadow rays sample the same light; else 0
    uint flags;              // of the path from here on
    uint scatter;            // Scatter of the lobe
    vec3 gather_throughput;  // of the ray of a final gather: the BSDF of a diffuse lobe over that of a Lambertian one
};

#ifdef FILTERS_GLOSSY
// The pdf by which a rough lobe scatters the path, 1/sr.
float filtered_pdf = NO_PDF;
#endif

// u: selects reflection or transmission, below the selection weight of both.
BsdfSample sample_diffuse(SurfaceVertex vertex, LobeSelection lobes, float u, vec2 disk) {
    CameraPath path = vertex.path;
    Closure closure = vertex.closure;
    BsdfSample bsdf;
    float reflected = largest(path.throughput * closure.diffuse);
    bsdf.transmitted = u >= reflected;
    bsdf.probability = bsdf.transmitted ? lobes.stored.x - reflected : reflected;
    bsdf.normal = unpack_unit_vector(closure.diffuse_normal);
    if (bsdf.transmitted) bsdf.normal = -bsdf.normal;
    bsdf.direction = cosine_hemisphere(bsdf.normal, disk);
    bsdf.weight = bsdf.transmitted ? closure.translucent : closure.diffuse;
    bsdf.pdf = bsdf.probability * lobes.survival / lobes.total * max(dot(bsdf.normal, bsdf.direction), 0.0) / PI;
    bsdf.flags =
        (path.flags & ~(PATH_TRANSMITTED | PATH_SINGULAR | PATH_LIGHTS_FOUND | PATH_SEEN_THROUGH)) | PATH_DIFFUSE;
    bsdf.scatter = SCATTER_DIFFUSE;
    vec3 normal = bsdf.transmitted ? -bsdf.normal : bsdf.normal;
    bsdf.gather_throughput = diffuse_factor(closure, normal, -vertex.ray.direction, bsdf.direction, !bsdf.transmitted)
                             * terminator_factor(closure.flags, normal, bsdf.direction);
    return bsdf;
}

// Straight through the surface. Shadow rays that it does not stop go on sampling the same lights as the ray.
BsdfSample sample_transparent(SurfaceVertex vertex, LobeSelection lobes) {
    CameraPath path = vertex.path;
    vec3 direction = vertex.ray.direction;
    bool stops_shadow_rays = (vertex.closure.flags & CLOSURE_SHADOWLESS) == 0u;
    uint flags = stops_shadow_rays ? (path.flags & ~(PATH_LIGHTS_FOUND | PATH_SEEN_THROUGH)) | PATH_CAUSTIC
                                   : path.flags | (path.scatter_pdf > 0.0 ? PATH_SEEN_THROUGH : 0u);
    float probability = lobes.specular.x;
#ifdef RAY_PORTALS
    probability = largest(path.throughput * vertex.closure.transparent);
#endif
    return BsdfSample(direction, vertex.closure.transparent, -direction, probability, true,
                      stops_shadow_rays ? 0.0 : path.scatter_pdf, flags, SCATTER_NONE, vec3(1.0));
}

#ifdef RAY_PORTALS
#include "camera_paths/importons/ray_portals.glsl"
#endif

// By one of the three lobes. weights: of those that are specular, or that store photons; u: selects the lobe, below
// the sum of their weights.
BsdfSample sample_selected_lobe(SurfaceVertex vertex, LobeSelection lobes, vec4 weights, float u, RaySamples samples) {
    CameraPath path = vertex.path;
    Closure closure = vertex.closure;
    vec3 wo = -vertex.ray.direction;
    BsdfSample bsdf;
    int selected = u < weights.y ? 0 : (u < weights.y + weights.z ? 1 : 2);
    bsdf.probability = weights[1 + selected];
    MicrofacetLobe lobe = stored_lobe(vertex.index, selected);
    bsdf.normal = lobe_normal(lobe);
    LobeSample sampled = sample_lobe(lobe, bsdf.normal, wo, samples.disk, samples.component, true);
    bsdf.pdf = 0.0;
    if (iteration.next_event != 0u && lobe.kind != LOBE_NONE && lobe.alpha > MIN_MIS_ALPHA)
        bsdf.pdf = selection_probability(bsdf.probability, lobes) * lobe_pdf(lobe, bsdf.normal, wo, sampled.direction);
#ifdef FILTERS_GLOSSY
    if (lobe.kind != LOBE_NONE && lobe.alpha > MIN_MIS_ALPHA)
        filtered_pdf = bsdf.probability / lobes.total * lobe_pdf(lobe, bsdf.normal, wo, sampled.direction);
#endif
    bsdf.direction = sampled.direction;
    bsdf.weight = sampled.weight * lobe_shadowing(lobe, closure.shading_normal, sampled.direction);
    if (lobe_is_hair(lobe.kind))
        sampled.transmitted = dot(sampled.direction, unpack_unit_vector(closure.geometric_normal)) < 0.0;
    bsdf.transmitted = sampled.transmitted;
    bsdf.scatter = lobe_scatter(lobe.kind, sampled.transmitted);
    bool lights_found = iteration.next_event != 0u && !sampled.transmitted
                        && looks_for_reflected_lights(lobe, weights[1 + selected], lobes.total, wo,
                                                      min(MIN_MIS_ALPHA, iteration.specular_alpha));
    bsdf.flags = (path.flags
                  & ~(PATH_CAMERA_TRANSPARENT | PATH_DIFFUSE | PATH_TRANSMITTED | PATH_SINGULAR | PATH_LIGHTS_FOUND
                      | PATH_SEEN_THROUGH))
                 | PATH_CAUSTIC | (sampled.transmitted ? PATH_TRANSMITTED : 0u)
                 | (lobe.alpha <= MIN_MIS_ALPHA ? PATH_SINGULAR : 0u) | (lights_found ? PATH_LIGHTS_FOUND : 0u)
                 | dispersed_flag(closure, lobe, sampled.transmitted);
#ifdef TRANSPARENT_GLASS
    bsdf.flags = with_clear_glass(bsdf.flags, path.flags, lobe, sampled.transmitted);
#endif
    bsdf.gather_throughput = vec3(1.0);
    return bsdf;
}

// A final gather follows the lobes that store photons, and all other rays the specular and transparent ones. u: selects
// one of these, below the sum of their weights. The lobes come first in the code because they need most registers:
// values of the other branches would be kept beside them.
BsdfSample sample_bsdf(SurfaceVertex vertex, LobeSelection lobes, bool gathers, float u, RaySamples samples) {
    vec4 weights = gathers ? lobes.stored : lobes.specular;
    BsdfSample bsdf;
    if (!(u < weights.x)) bsdf = sample_selected_lobe(vertex, lobes, weights, u - weights.x, samples);
    else if (gathers) bsdf = sample_diffuse(vertex, lobes, u, samples.disk);
#ifdef RAY_PORTALS
    else if (!(u < largest(vertex.path.throughput * vertex.closure.transparent))) bsdf = sample_ray_portal(vertex);
#endif
    else bsdf = sample_transparent(vertex, lobes);
    return bsdf;
}
