// SPDX-License-Identifier: GPL-3.0-or-later
// Selection of the lobe by which a camera path goes on, with weights that estimate how much light each lobe brings.
// The includer declares the block Closures before.

#include "common/iteration.glsl"
#include "common/bsdf/stored_lobes.glsl"
#ifdef RAY_PORTALS
#include "common/bsdf/ray_portal.glsl"
#endif

float sum(vec4 v) { return v.x + v.y + v.z + v.w; }

// Selection weights of a closure. They are not normalized: the probability of a lobe is its weight over the total,
// times the survival probability of the path.
struct LobeSelection {
    vec4 specular;  // of the transparent part with the ray portal, and of the three lobes where they are specular
    vec4 stored;    // of the diffuse and translucent parts together, and of the three lobes where they store photons
    float total;  // sum of the weights of all lobes by which the path may go on: a final gather follows the stored ones
    float survival;  // probability of surviving Russian roulette
};

// Russian roulette sets in once the throughput of a path has fallen. It spares camera rays, since half of the paths
// would end at dark surfaces that the camera sees.
float survival_probability(float total_weight, bool is_camera_ray) {
    return is_camera_ray ? 1.0 : min(1.0, 4.0 * total_weight);
}

// The selection at a vertex of a camera path; throughput: of the path there.
LobeSelection select_lobes(uint path, Closure closure, vec3 throughput, vec3 wo, bool can_gather, bool is_camera_ray) {
    LobeSelection selection = LobeSelection(
        vec4(largest(throughput * closure.transparent), 0.0, 0.0, 0.0),
        vec4(largest(throughput * closure.diffuse) + largest(throughput * closure.translucent), 0.0, 0.0, 0.0), 0.0,
        1.0);
#ifdef RAY_PORTALS
    selection.specular.x += largest(throughput * ray_portal_weight(closure, closures[path].lobes[CLOSURE_LOBES - 1]));
#endif
    for (int k = 0; k < closure_lobes(closure); ++k) {
        MicrofacetLobe lobe = stored_lobe(path, k);
        float weight = largest(throughput * lobe_albedo(lobe, lobe_cosine(lobe, wo)));
        if (lobe_is_specular(lobe, iteration.specular_alpha)) selection.specular[1 + k] = weight;
        else if (lobe_stores(lobe, iteration.specular_alpha)) selection.stored[1 + k] = weight;
    }
    selection.total = sum(selection.specular) + (can_gather ? sum(selection.stored) : 0.0);
    selection.survival = survival_probability(selection.total, is_camera_ray);
    return selection;
}

#ifdef MEDIA
// The selection of a path that the media along its ray have let pass, and whose throughput is larger by that; passing:
// the probability with which they do. flags: of the path.
LobeSelection passed_media(LobeSelection selection, float passing, uint flags) {
    float weight = 1.0 / max(passing, 1e-20), total = weight * selection.total;
    return LobeSelection(weight * selection.specular, weight * selection.stored, total,
                         survival_probability(total, (flags & PATH_CAMERA_TRANSPARENT) != 0u));
}
#endif

// Probability that a path goes on by a lobe of this weight, survival included.
float selection_probability(float weight, LobeSelection selection) {
    return weight * selection.survival / max(selection.total, 1e-20);
}

// Whether a smooth lobe reflects so seldom that a shadow ray looks for light objects along its reflection: paths that
// go there would find them seldom, and then very bright. Where mirrors see other objects than stop shadow rays, no such
// ray stands for a path that is reflected. weight, total: of the selection. alpha: up to which lobes are
// smooth.
bool looks_for_reflected_lights(MicrofacetLobe lobe, float weight, float total, vec3 wo, float alpha) {
    if (iteration.mirrors_see_others != 0u || !lobe_is_specular(lobe, alpha) || !lobe_has_facets(lobe.kind)
        || !(weight > 0.0))
        return false;
    float probability = facet_fresnel(lobe, lobe_cosine(lobe, wo)).reflection_probability;
    return probability > 0.0 && weight * probability < 0.5 * total;
}
