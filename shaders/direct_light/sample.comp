#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Shadow rays from the camera paths' vertices to a sampled light.

layout(local_size_x = 64) in;

#include <DirectLightParameters>
#include "common/living_paths.glsl"
#include "common/low_discrepancy.glsl"
#include "common/bsdf/closure.glsl"
#include "common/camera_path.glsl"
#include "materials/medium.glsl"
layout(std140, binding = 0) uniform Parameters { DirectLightParameters parameters; };
#include "emission/light_tree.glsl"
layout(std430, binding = 0) readonly buffer Closures;
layout(std430, binding = 1) readonly buffer Rays;
layout(std430, binding = 2) readonly buffer CameraPaths;
layout(std430, binding = 3) writeonly buffer ShadowRays;
layout(std430, binding = 9) writeonly buffer LightTriangles;
layout(std430, binding = 8) writeonly buffer Contributions;

// The alpha above which lobes are evaluated toward lights.
float smoothest_lit(bool gathered) {
    return gathered ? parameters.specular_alpha : min(SMOOTHEST_LIT, parameters.specular_alpha);
}

// Whether any part of a closure is.
bool can_be_lit(Closure closure, bool gathered) {
    bool lit = largest(closure.diffuse) > 0.0 || largest(closure.translucent) > 0.0;
    for (int k = 0; k < CLOSURE_LOBES; ++k) lit = lit || lobe_stores(closure_lobe(closure, k), smoothest_lit(gathered));
    return lit;
}

// Lights are found by shadow rays. Light of the environment is found by gathering rays as well, and specular lobes
// are followed to all lights with extent: the power heuristic weights both ways, part by part of the closure.
// What specular lobes reflect after a gathering ray is the business of the photons where that ray began.
// Times the cosine, of each part its own. front: the light is on the geometric normal's side. light_pdf: in 1/sr, the
// choice of the light included.
vec3 evaluate_closure(Closure closure, vec3 throughput, bool gathered, bool gathers, vec3 wo, vec3 wi, bool front,
                      uint visibility,
                      bool environment, float light_pdf) {
    vec4 shares = camera_path_shares(closure, throughput, wo, parameters.specular_alpha, false),
        gathering_shares = vec4(0.0);
    if (gathers) gathering_shares = camera_path_shares(closure, throughput, wo, parameters.specular_alpha, true);
    float total = sum(shares) + sum(gathering_shares);
    vec3 value = (visibility & RAY_DIFFUSE) != 0u ? diffuse_scattered(closure, wo, wi, front) : vec3(0.0);
    if (gathers && environment) {
        float cosine = abs(dot(unpack_unit_vector(closure.diffuse_normal), wi));
        float part = largest(throughput * (front ? closure.diffuse : closure.translucent));
        value *= power_heuristic(light_pdf, part * path_survival(total) / max(total, 1e-20) * cosine / PI);
    }
    if ((visibility & (front ? RAY_GLOSSY : RAY_TRANSMISSION)) == 0u) return value;
    for (int k = 0; k < CLOSURE_LOBES; ++k) {
        MicrofacetLobe lobe = closure_lobe(closure, k);
        if (!lobe_stores(lobe, smoothest_lit(gathered))) continue;
        bool specular = lobe_is_specular(lobe, parameters.specular_alpha);
        float weight = 1.0;
        if (light_pdf > 0.0 && parameters.last_segment == 0u && (specular || (gathers && environment)))
            weight = power_heuristic(light_pdf, lobe_probability(specular ? shares : gathering_shares, total, k)
                                                    * lobe_pdf(lobe, lobe_normal(lobe), wo, wi));
        value += weight * lobe_scattered(closure, lobe, wo, wi, front);
    }
    return value;
}

bool lit_from_behind(Closure closure) {
    bool transmits = largest(closure.translucent) > 0.0;
    for (int k = 0; k < CLOSURE_LOBES; ++k) transmits = transmits || lobe_transmits(closure_lobe(closure, k).kind);
    return transmits;
}

void main() {
    uint index = living_path();
    if (index == NO_PATH) return;
    shadow_rays[index].maximum_distance = 0.0;
    contributions[index] = vec4(0.0);
    light_triangles[index] = NO_TRIANGLE;
    Ray ray = rays[index];
    Closure closure = closures[index];
    if (!(ray.maximum_distance > 0.0) || !closure_hit(closure)) return;
    bool gathered = (camera_paths[index].flags & PATH_GATHERED) != 0u;
    if (!can_be_lit(closure, gathered)) return;
    uvec4 choices = pcg4d(uvec4(parameters.first_pixel + index, parameters.segment, parameters.seed,
                                STAGE_DIRECT_LIGHT << 24u));
    vec4 u = vec4(scrambled_sobol(parameters.iteration - 1u, choices),
                  scrambled_sobol(parameters.iteration - 1u, pcg4d(choices)));
    vec3 geometric = unpack_unit_vector(closure.geometric_normal);
    bool gathers = parameters.final_gather != 0u && parameters.last_segment == 0u
                && path_gathers(camera_paths[index].flags, closure.distance, parameters.gathers_again_below);
    // An even environment is left to the gathering ray.
    float environment_irradiance = gathers && environment_is_even() ? 0.0 : parameters.environment_irradiance;
    LightChoice choice = choose_light_at(LitPoint(closure.position, geometric, lit_from_behind(closure)),
                                         environment_irradiance, u.x, u.y);
    if (!(choice.probability > 0.0)) return;
    Light light = lights[choice.light];
    LightSample sampled = sample_light(light, choice.triangle, closure.position, u.zw);
    if (!(largest(sampled.weight) > 0.0) || sampled.triangle == closure.triangle) return;
    float side = dot(geometric, sampled.direction);
    if (side == 0.0) return;
    vec3 throughput = camera_paths[index].throughput * segment_transmittance(camera_paths[index].flags, closure);
    // Weights take the densities that rays which meet a light can tell as well, whatever the choice at the point.
    float light_pdf = sampled.pdf * light.selection_probability;
    if (light.kind == LIGHT_MESH) light_pdf *= emissive_triangles[choice.triangle].share;
    vec3 scattered = evaluate_closure(closure, throughput, gathered, gathers, -ray.direction, sampled.direction,
                                      side > 0.0, light.flags, light.kind == LIGHT_WORLD, light_pdf);
    vec3 radiance = throughput * scattered * sampled.weight / choice.probability;
    if (!(largest(radiance) > 0.0)) return;
    contributions[index] = vec4(radiance, gathered ? 1.0 : 0.0);
    light_triangles[index] = sampled.triangle;
    vec3 origin = offset_from_surface(closure.position, side > 0.0 ? geometric : -geometric);
    Ray shadow = Ray(origin, closure.triangle, sampled.direction, INFINITY_DISTANCE);
    if (sampled.distance < INFINITY_DISTANCE) {
        // From the moved origin to the light, and just short of it: its own surface must not hide it.
        vec3 to_light = closure.position + sampled.distance * sampled.direction - origin;
        float distance = length(to_light);
        shadow.direction = to_light / distance;
        shadow.maximum_distance = distance * (1.0 - 1e-4);
    }
    shadow_rays[index] = shadow;
}
