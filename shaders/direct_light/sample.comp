#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint:
// lint: MEDIA=1
// lint: MEDIA=1 HETEROGENEOUS_MEDIA=1
// lint: HAIR_LOBES=1
// lint: ASHIKHMIN_LOBES=1
// lint: THIN_FILM_LOBES=1
// lint: PORTALS=1
// lint: COUNTS_BOUNCES=1
// lint: EMITTERS=lights/two_levels
// lint: EMITTERS=lights/two_levels MEDIA=1 HETEROGENEOUS_MEDIA=1
// lint: RAY_PORTALS=1
// Shadow rays from the camera paths' vertices to a sampled light, or to one that a smooth surface reflects.

layout(local_size_x = 64) in;

#include <DirectLightParameters>
#include "common/iteration.glsl"
#include "common/active_paths.glsl"
#include "common/low_discrepancy.glsl"
#include "common/bsdf/closure.glsl"
#include "common/camera_path.glsl"
#include "common/transparency.glsl"
#include "common/path_history.glsl"
#include "direct_light/media.glsl"
#include "materials/medium.glsl"
uniform Parameters { DirectLightParameters parameters; };
#include "lights/light_tree.glsl"
readonly buffer Closures;
#include "common/bsdf/lobe_selection.glsl"
readonly buffer Rays;
readonly buffer CameraPaths;
writeonly buffer ShadowRays;
writeonly buffer LightTriangles;
writeonly buffer Contributions;
#include "camera_paths/importons/final_gather.glsl"
writeonly buffer LightSplits;
#include "camera_paths/last_vertex.glsl"
#include EMITTERS "lights/one_level/hits.glsl"

// What glossy and transmissive lobes add to a sum that holds the diffuse ones' as well.
struct Parts {
    vec3 glossy;
    vec3 transmission;
};

// The alpha above which lobes are evaluated toward lights.
float smoothest_lit(bool gathered) {
    return gathered ? iteration.specular_alpha : min(MIN_MIS_ALPHA, iteration.specular_alpha);
}

// Whether a lobe is. What fibers scatter after a gathering ray is left to photons, as of all that store none.
bool lobe_is_lit(MicrofacetLobe lobe, bool gathered) {
    return lobe.kind != LOBE_NONE && lobe.alpha > smoothest_lit(gathered) && !(gathered && lobe_is_hair(lobe.kind));
}

// Whether any part of a closure is.
bool can_be_lit(uint index, Closure closure, bool gathered) {
    bool lit = largest(closure.diffuse) > 0.0 || largest(closure.translucent) > 0.0;
    for (int k = 0; k < closure_lobes(closure); ++k) lit = lit || lobe_is_lit(stored_lobe(index, k), gathered);
    return lit;
}

// Lights are found by shadow rays. Those that gathering rays share are found by these as well, and specular lobes
// are followed to all lights with extent: the power heuristic weights both ways, part by part of the closure.
// What specular lobes reflect after a gathering ray is the business of the photons where that ray began.
// Times the cosine, of each part its own. front: the light is on the geometric normal's side. light_pdf: in 1/sr, the
// choice of the light included. is_shared: whether gathering rays find the light.
vec3 evaluate_closure(uint index, Closure closure, vec3 throughput, LobeSelection lobes, bool gathered, vec3 wo,
                      vec3 wi, bool front, uint visibility, bool is_shared, float light_pdf, out Parts parts) {
    parts = Parts(vec3(0.0), vec3(0.0));
    vec3 value = (visibility & RAY_DIFFUSE) != 0u ? diffuse_scattered(closure, wo, wi, front) : vec3(0.0);
    if (is_shared) {
        float cosine = abs(dot(unpack_unit_vector(closure.diffuse_normal), wi));
        float part = largest(throughput * (front ? closure.diffuse : closure.translucent));
        value *= power_heuristic(light_pdf, selection_probability(part, lobes) * cosine / PI);
    }
    if ((visibility & (front ? RAY_GLOSSY : RAY_TRANSMISSION)) == 0u) return value;
    for (int k = 0; k < closure_lobes(closure); ++k) {
        MicrofacetLobe lobe = stored_lobe(index, k);
        vec3 normal = lobe_normal(lobe);
        float cosine = dot(normal, wi);
        if (!lobe_is_lit(lobe, gathered) || !lobe_faces(lobe, cosine, front)) continue;
        LobeValue scattered = lobe_value(lobe, normal, wo, wi);
        bool specular = lobe_is_specular(lobe, iteration.specular_alpha);
        float weight = 1.0;
        if (light_pdf > 0.0 && (specular || (is_shared && lobe.alpha > MIN_MIS_ALPHA)))
            weight *= power_heuristic(light_pdf,
                                      selection_probability((specular ? lobes.specular : lobes.stored)[1 + k], lobes)
                                          * scattered.pdf);
        vec3 part = weight * (abs(cosine) * lobe_shadowing(lobe, closure.shading_normal, wi) * scattered.bsdf);
        value += part;
        uint scatter = lobe_scatter(lobe.kind, !front);
        if (scatter == SCATTER_GLOSSY) parts.glossy += part;
        else if (scatter == SCATTER_TRANSMISSION) parts.transmission += part;
    }
    return value;
}

// Light that arrives along a direction if nothing is in the way.
struct Arriving {
    vec3 radiance;
    vec3 direction;
    float distance;
    uint light;
    EmitterNumber triangle;
};

const Arriving NOTHING_ARRIVES = Arriving(vec3(0.0), vec3(0.0), 0.0, 0u, NO_EMITTER);

vec3 fraction_of(vec3 part, vec3 whole) {
    return mix(part / max(whole, vec3(1e-35)), vec3(0.0), lessThanEqual(whole, vec3(0.0)));
}

// Light that may arrive, of which one is to be chosen by weight: the one so far over its weight, and the sum of all.
struct Candidates {
    Arriving chosen;
    float weights;
    float u;
};

void add_candidate(inout Candidates candidates, float weight, Arriving arriving) {
    if (!(weight > 0.0)) return;
    candidates.weights += weight;
    if (!reservoir_accept(weight, candidates.weights, candidates.u)) return;
    candidates.chosen = arriving;
    candidates.chosen.radiance /= weight;
}

// Of light objects and emissive triangles, where smooth lobes that reflect little reflect them. A path would go there
// as seldom.
Arriving arriving_reflected(uint index, Closure closure, vec3 throughput, LobeSelection lobes, vec3 wo, uint flags,
                            uvec4 choices) {
    float alpha = smoothest_lit(false);
    bool any_specular = false;
    for (int k = 0; k < closure_lobes(closure); ++k)
        any_specular = any_specular || lobe_is_specular(stored_lobe(index, k), alpha);
    if (!any_specular) return NOTHING_ARRIVES;
    uint light_set = light_set_at(closure.triangle);
    vec3 geometric = unpack_unit_vector(closure.geometric_normal);
    vec2 disk = sample_disk(scrambled_sobol(parameters.light_sample, pcg4d(choices + 1u)));
    Candidates candidates =
        Candidates(NOTHING_ARRIVES, 0.0, scrambled_sobol(parameters.light_sample, pcg4d(choices + 2u)).x);
    for (int k = 0; k < closure_lobes(closure); ++k) {
        MicrofacetLobe lobe = stored_lobe(index, k);
        if (!looks_for_reflected_lights(lobe, lobes.specular[1 + k], lobes.total, wo, alpha)) continue;
        LobeSample sampled = sample_lobe(lobe, lobe_normal(lobe), wo, disk, 0.0, true);
        if (sampled.transmitted || !(largest(sampled.weight) > 0.0) || dot(sampled.direction, geometric) <= 0.0)
            continue;
        ScatterPoint from = ScatterPoint(LitPoint(closure.position, vec3(0.0), false, light_set), 0.0, 0.0, false, 0u);
        IntersectedLights objects =
            intersect_lights(from, sampled.direction, vec2(0.0, INFINITY_DISTANCE), RAY_GLOSSY, candidates.u, flags);
        candidates.u = objects.u;
        vec3 reflected = throughput * sampled.weight * lobe_shadowing(lobe, closure.shading_normal, sampled.direction)
                         * facet_fresnel(lobe, dot(wo, normalize(wo + sampled.direction))).reflection_probability;
        vec3 radiance = reflected * objects.chosen * objects.weights;
        add_candidate(candidates, largest(radiance),
                      Arriving(radiance, sampled.direction, objects.distance, objects.light, NO_EMITTER));
        EmitterNumber emissive;
        Hit hit = intersect_emitters(closure.position, sampled.direction, closure.triangle, light_set, emissive);
        if (hit.triangle == NO_TRIANGLE) continue;
        if (parameters.crosses_media == 0u)
            reflected *= segment_transmittance(flags, closure.position, sampled.direction, hit.distance);
        EmissiveTriangle emitter = emissive_triangles[emitter_number(emissive)];
        radiance = reflected * sampled_radiance(emitter);
        add_candidate(candidates, largest(reflected * emitter.radiance),
                      Arriving(radiance, sampled.direction, hit.distance, 0u, met_triangle(hit, emissive)));
    }
    candidates.chosen.radiance *= candidates.weights;
    return candidates.chosen;
}

// Media that the shadow ray of a path begins in, by the flags of a path that is in them.
void set_shadow_media(uint index, uint flags) {
#ifdef MEDIA
    shadow_media[index] = flags & ~PATH_MASK;
#endif
}

#if defined(MEDIA) && !defined(PORTALS)
// An even environment lights a diffuse surface by the cosine. Behind a medium neighbors do not reuse what is found.
void sample_even_world(inout LightSample sampled, Closure closure, vec2 u) {
    if (!environment_is_even() || closure_lobes(closure) > 0 || largest(closure.translucent) > 0.0) return;
    vec3 normal = unpack_unit_vector(closure.diffuse_normal);
    sampled.direction = sample_cosine_hemisphere(normal, u);
    sampled.pdf = max(dot(normal, sampled.direction), 1e-6) / PI;
    sampled.weight = world_radiance(sampled.direction) / sampled.pdf;
}
#endif

// Of a light that is chosen by what it may give at the point.
Arriving arriving_from_light(uint index, CameraPath path, Closure closure, vec3 throughput, LobeSelection lobes,
                             vec3 wo, bool gathered, bool gathers, uvec4 choices, out Parts parts) {
    parts = Parts(vec3(0.0), vec3(0.0));
    if (!can_be_lit(index, closure, gathered)) return NOTHING_ARRIVES;
    // Of the light, then of a light deep in the tree, and of the point on the light: even together.
    vec4 u = scrambled_sobol4(parameters.light_sample, choices).zwxy;
    vec3 facing = lit_normal(closure);
    LightChoice choice = choose_light_at(
        LitPoint(closure.position, facing, lit_from_behind(index, closure), light_set_at(closure.triangle)),
        chosen_environment_irradiance(closure.position, gathers), u.x, u.y);
    Light light = lights[choice.light];
    LightSample sampled = sample_light(light, choice.triangle, closure.position, u.zw);
#if defined(MEDIA) && !defined(PORTALS)
    if (gathered && light.kind == LIGHT_WORLD) sample_even_world(sampled, closure, u.zw);
#endif
    float side = dot(facing, sampled.direction);
    bool too_far = bounces_of(path.depth) > light.max_bounces;
    // All at once, since what each branch gives back would be kept beside what others compute.
    bool arrives = choice.probability > 0.0 && !too_far && largest(sampled.weight) > 0.0
                   && sampled.triangle != hit_emitter(closure.triangle) && side != 0.0;
    if (!arrives) return NOTHING_ARRIVES;
    bool environment = light.kind == LIGHT_WORLD;
    // Gathering rays that leave the scene know of no choice at the point.
    float light_pdf = sampled.pdf * (environment ? light.selection_probability : choice.probability);
    bool is_plain = sampled.triangle == NO_EMITTER || emitter_link(sampled.triangle) == 0u;
    bool leaves = (dot(unpack_unit_vector(closure.geometric_normal), sampled.direction) > 0.0) == (side > 0.0);
    bool is_shared = gathers && leaves && light_pdf > 0.0
                     && (environment || (!gathered && is_plain && is_shared_light(light, bounces_of(path.depth))));
    vec3 scattered = evaluate_closure(index, closure, throughput, lobes, gathered, wo, sampled.direction, side > 0.0,
                                      light.flags, is_shared, light_pdf, parts);
    parts = Parts(fraction_of(parts.glossy, scattered), fraction_of(parts.transmission, scattered));
    uint beyond = path.flags;
    if (side <= 0.0) beyond = cross_surface(beyond, closure.material, closure_backfacing(closure));
    vec3 transmittance = vec3(1.0);
    if (parameters.crosses_media == 0u)
        transmittance = segment_transmittance(beyond, closure.position, sampled.direction, sampled.distance);
    set_shadow_media(index, beyond);
    return Arriving(throughput * transmittance * scattered * sampled.weight / choice.probability, sampled.direction,
                    sampled.distance, choice.light, sampled.triangle);
}

// The LightLink by which a shadow ray meets what is in its way. Reflections of lights without shadows are hidden like
// others.
uint arriving_link(Arriving arriving, bool reflected) {
    if (iteration.links_lights == 0u) return 0u;
    if (arriving.triangle != NO_EMITTER) return emitter_link(arriving.triangle);
    Light light = lights[arriving.light];
    return reflected && (light.flags & LIGHT_SHADOWLESS) != 0u ? 0u : light.link;
}

// Whether no light can be scattered where a path arrives.
bool is_unlit(CameraPath path, Ray ray, Closure closure) {
#ifdef MEDIA
    // Surfaces of volumes alone.
    if (closure_lobes(closure) == 0 && !(largest(closure.diffuse + closure.translucent) > 0.0)) return true;
#endif
    return !(ray.maximum_distance > 0.0) || !closure_hit(closure) || is_last_vertex(path);
}

// The lobes by which the path may go on, whether or not media have scattered it before. throughput: at the surface.
LobeSelection select_lobes(uint index, CameraPath path, Ray ray, Closure closure, vec3 throughput, bool gathers) {
    bool is_camera_ray = (path.flags & PATH_CAMERA_TRANSPARENT) != 0u;
    LobeSelection lobes = select_lobes(index, closure, throughput, -ray.direction, gathers, is_camera_ray);
#ifdef MEDIA
    if (!(path.medium_passing < 1.0)) return lobes;
    vec3 passing = segment_transmittance(path.flags, ray.origin, ray.direction, closure.distance);
    lobes = passed_media(lobes, dot(passing, vec3(1.0 / 3.0)), path.flags);
#endif
    return lobes;
}

void leave_no_light(uint index) {
    shadow_rays[index].maximum_distance = 0.0;
    contributions[index] = vec4(0.0);
    light_triangles[index] = NO_TRIANGLE;
}

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    leave_no_light(index);
    Ray ray = rays[index];
    Closure closure = closures[index];
    CameraPath path = camera_paths[index];
    uint flags = path.flags;
    if (is_unlit(path, ray, closure)) return;
    limit_transparency(closure, path.depth, iteration.transparent_max_bounces);
    bool gathered = is_final_gather(path), gathers = can_gather(path, closure);
    vec3 throughput = path.throughput * segment_transmittance(flags, ray.origin, ray.direction, closure.distance);
    uvec4 choices =
        pcg4d(uvec4(parameters.first_pixel + index, parameters.segment, iteration.seed, STAGE_DIRECT_LIGHT << 24u));
#ifdef HAIR_LOBES
    fiber_seed = choices.w + 2654435769u * parameters.light_sample;
#endif
    vec3 viewer = -ray.direction;
    LobeSelection lobes = select_lobes(index, path, ray, closure, throughput, gathers);
    Parts parts;  // shares of it
    Arriving arriving =
        arriving_from_light(index, path, closure, throughput, lobes, viewer, gathered, gathers, choices, parts);
    Arriving reflected = NOTHING_ARRIVES;
    if (!gathered) reflected = arriving_reflected(index, closure, throughput, lobes, viewer, flags, choices);
    // One ray for both: by what they would add.
    bool takes_reflected = false;
    float weight = largest(arriving.radiance), reflected_weight = largest(reflected.radiance);
    if (!(weight + reflected_weight > 0.0)) return;
    if (reflected_weight > 0.0) {
        float total = weight + reflected_weight;
        float u = scrambled_sobol(parameters.light_sample, pcg4d(choices + 2u)).y;
        takes_reflected = reservoir_accept(reflected_weight, total, u);
        if (takes_reflected) {
            arriving = reflected;
            set_shadow_media(index, flags);
            parts = Parts(vec3(1.0), vec3(0.0));
        }
        arriving.radiance *= total / (takes_reflected ? reflected_weight : weight);
    }
    uint link = arriving_link(arriving, takes_reflected);
    float code = takes_reflected ? reflected_code(link) : signed_code(gathered, link);
    contributions[index] = vec4(parameters.sample_weight * arriving.radiance, code);
    light_triangles[index] = keep_sampled_emitter(arriving.triangle, index);
    if (parameters.splits_light != 0u)
        light_splits[index] = LightSplit(parts.glossy, arriving.light, parts.transmission, 0.0);
    vec3 geometric = unpack_unit_vector(closure.geometric_normal);
    float offset = closures[index].ray_offset;
    if (dot(lit_normal(closure), arriving.direction) <= 0.0) offset = -offset;
    vec3 origin = closure.position + offset * geometric;
    Ray shadow = Ray(origin, closure.triangle, arriving.direction, INFINITY_DISTANCE);
    if (arriving.distance < INFINITY_DISTANCE) {
        // From the moved origin to the light.
        vec3 to_light = closure.position + arriving.distance * arriving.direction - origin;
        float distance = length(to_light);
        shadow.direction = to_light / distance;
        shadow.maximum_distance = shadow_ray_length(distance);
    }
    shadow_rays[index] = shadow;
}
