#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Next-event rays from the camera paths' vertices to a sampled light.

layout(local_size_x = 64) in;

#include <Ray>
#include <DirectLightParameters>
#include "common/invocation.glsl"
#include "common/random.glsl"
#include "common/bsdf/closure.glsl"
#include "common/camera_path.glsl"
#include "materials/medium.glsl"
layout(std140, binding = 0) uniform Parameters { DirectLightParameters parameters; };
#include "emission/lights.glsl"
layout(std430, binding = 0) readonly buffer Closures { Closure closures[]; };
layout(std430, binding = 1) readonly buffer Rays { Ray rays[]; };
layout(std430, binding = 2) readonly buffer CameraPaths { CameraPath camera_paths[]; };
layout(std430, binding = 3) writeonly buffer ShadowRays { Ray shadow_rays[]; };
layout(std430, binding = 9) writeonly buffer LightTriangles { uint light_triangles[]; };
layout(std430, binding = 8) writeonly buffer Contributions { vec4 contributions[]; };

// Diffuse and rough lobes are lit by these rays alone. Specular lobes are also followed to lights with
// extent: the power heuristic shares those out between both ways, lobe by lobe.
// What specular lobes reflect after a gathering ray is the business of the photons where that ray began.
// Times the cosine, of each part its own. front: the light is on the geometric normal's side.
vec3 evaluate_closure(Closure closure, vec3 throughput, bool gathered, vec3 wo, vec3 wi, bool front, uint visibility, float light_density) {
    vec3 value = (visibility & RAY_DIFFUSE) != 0u ? diffuse_scattered(closure, wo, wi, front) : vec3(0.0);
    if ((visibility & (front ? RAY_GLOSSY : RAY_TRANSMISSION)) == 0u) return value;
    vec4 shares = camera_path_shares(closure, throughput, wo, parameters.specular_alpha, false);
    float total = sum(shares);
    if (parameters.final_gather != 0u && !gathered)
        total += sum(camera_path_shares(closure, throughput, wo, parameters.specular_alpha, true));
    for (int k = 0; k < CLOSURE_LOBES; ++k) {
        MicrofacetLobe lobe = closure_lobe(closure, k);
        if (!lobe_stores(lobe, gathered ? parameters.specular_alpha : min(SMOOTHEST_LIT, parameters.specular_alpha))) continue;
        float share = 1.0;
        if (lobe_is_specular(lobe, parameters.specular_alpha) && light_density > 0.0 && parameters.last_segment == 0u)
            share = first_way_share(light_density, lobe_probability(shares, total, k) * lobe_density(lobe, lobe_normal(lobe), wo, wi));
        value += share * lobe_scattered(closure, lobe, wo, wi, front);
    }
    return value;
}

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    shadow_rays[index].maximum_distance = 0.0;
    contributions[index] = vec4(0.0);
    light_triangles[index] = NO_TRIANGLE;
    Ray ray = rays[index];
    Closure closure = closures[index];
    if (!(ray.maximum_distance > 0.0) || !closure_hit(closure)) return;
    vec4 u = progressive_random(parameters.seed, parameters.iteration, STAGE_DIRECT_LIGHT, parameters.segment, parameters.first_pixel + index);
    Light light = lights[choose_light(u.x)];
    LightSample sampled = sample_light(light, closure.position, u.y, u.zw);
    if (!(largest(sampled.weight) > 0.0) || sampled.triangle == closure.triangle) return;
    vec3 geometric = unpack_unit_vector(closure.geometric_normal);
    float side = dot(geometric, sampled.direction);
    if (side == 0.0) return;
    vec3 throughput = camera_paths[index].throughput * segment_transmittance(camera_paths[index].flags, closure);
    bool gathered = (camera_paths[index].flags & PATH_GATHERED) != 0u;
    vec3 scattered = evaluate_closure(closure, throughput, gathered, -ray.direction, sampled.direction,
                                      side > 0.0, light.flags, sampled.density * light.selection_probability);
    vec3 radiance = throughput * scattered * sampled.weight / light.selection_probability;
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
