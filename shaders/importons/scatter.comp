#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// TraceImportons: collect what a camera path sees shine, leave an importon for the lobes that store
// photons, and go on by the specular ones.

layout(local_size_x = 64) in;

#include <ScatterImportonsParameters>
#include "common/living_paths.glsl"
#include "common/low_discrepancy.glsl"
#include "common/bsdf/closure.glsl"
#include "common/camera_path.glsl"
#include "common/gathering.glsl"
#include "common/world_caustics.glsl"
#include "gbuffer/projections.glsl"
#include "materials/medium.glsl"
layout(std140, binding = 0) uniform Parameters { ScatterImportonsParameters parameters; };
#include "emission/light_tree.glsl"
layout(std430, binding = 0) readonly buffer Closures;
layout(std430, binding = 1) buffer Rays;
layout(std430, binding = 2) buffer CameraPaths;
layout(std430, binding = 3) writeonly buffer Importons;
layout(std430, binding = 12) readonly buffer LitCatchers { uint lit_catchers[]; };
layout(std430, binding = 11) buffer GatheringVertices;
layout(std430, binding = 8) buffer Radiances;
layout(std430, binding = 9) readonly buffer Camera;
layout(std430, binding = 15) readonly buffer RadiusFactors;

Importon make_importon(Closure closure, vec3 throughput, vec3 viewer, float radius, float u, uint gathers) {
    Importon importon = Importon(closure.position, radius, viewer, closure.geometric_normal,
                                 throughput * closure.diffuse / PI, closure.diffuse_normal,
                                 throughput * closure.translucent / PI, closure.diffuse_roughness,
                                 vec3(0.0), LOBE_NONE, vec3(0.0), 0.0, 1.0, 0u, ISOTROPIC, 0u, gathers,
                                 closure.shading_normal, 0u, 0u);
    // One rough lobe stands for all of them, chosen by its albedo.
    float total = 0.0;
    for (int k = 0; k < CLOSURE_LOBES; ++k) {
        MicrofacetLobe lobe = closure_lobe(closure, k);
        if (!lobe_stores(lobe, parameters.specular_alpha)) continue;
        float share = largest(throughput * lobe_albedo(lobe, lobe_cosine(lobe, viewer)));
        if (share <= 0.0) continue;
        total += share;
        if (u * total < share) {
            u = u * total / share;
            importon.lobe_weight = throughput * lobe.weight / share;
            importon.lobe_kind = pack_kind(lobe.kind, lobe.tint);
            importon.lobe_f0 = passes_by_f0(lobe.kind) ? throughput * lobe.f0 / share : lobe.f0;
            importon.lobe_alpha = lobe.alpha;
            importon.lobe_ior = lobe.ior;
            importon.lobe_normal = lobe.normal;
            importon.lobe_anisotropy = lobe.anisotropy;
        } else u = (u * total - share) / (total - share);
    }
    importon.lobe_weight *= total;
    uint kind = unpack_kind(importon.lobe_kind);
    if (passes_by_f0(kind)) importon.lobe_f0 *= total;
    if (kind == LOBE_NONE && largest(importon.diffuse + importon.translucent) <= 0.0) importon.radius = 0.0;
    return importon;
}

// In 1/sr, of shadow rays to the environment from a vertex that sends a ray on.
float environment_shadow_ray_pdf(vec3 direction) {
    bool left_to_rays = parameters.final_gather != 0u && environment_is_even();
    return left_to_rays ? 0.0 : parameters.world_selection * world_density(direction);
}

void main() {
    uint index = living_path();
    if (index == NO_PATH) return;
    CameraPath path = camera_paths[index];
    Ray ray = rays[index];
    importons[index].radius = 0.0;
    rays[index].maximum_distance = 0.0;
    if (parameters.segment == 0u) gathering_vertices[index].shared_radius = -1.0;
    if (!(ray.maximum_distance > 0.0)) return;
    Closure closure = closures[index];
    bool hit = closure_hit(closure);
    bool straight = (path.flags & PATH_STRAIGHT) != 0u, gathered = (path.flags & PATH_GATHERED) != 0u;
    // What shines at the end of a gathering ray is direct light where the ray began, or a caustic there, which is left
    // to photons but for the environment's. Shadow rays find direct light, and share the environment's with this ray.
    if (gathered && !hit) {
        vec3 world = world_radiance(ray.direction);
        if ((path.flags & PATH_CAUSTIC) == 0u) {
            if (parameters.next_event == 0u) return;
            float weight = scattered_share(path.scatter_density, environment_shadow_ray_pdf(ray.direction));
            vec3 arrived = path.throughput * world * weight;
            if ((path.flags & PATH_GATHERED_AGAIN) != 0u) gathering_vertices[index].found = arrived;
            else radiances[index].rgb += gathering_vertices[index].weight * arrived;
            return;
        }
        float photons = world_photon_share(largest(world), parameters.world_photon_flux,
                                           gathering_vertices[index].radius);
        gathering_vertices[index].found = path.throughput * world * (1.0 - photons);
        return;
    }
    vec4 seen = vec4(0.0);

    vec3 lights_passed = gathered ? vec3(0.0)
                         : visible_light(ray.origin, ray.direction, hit ? closure.distance : INFINITY_DISTANCE,
                                         camera_ray_kind(path.flags), path.scatter_density);
    seen.rgb += path.throughput * lights_passed;
    if (!hit) {
        bool background = largest(lights_passed) <= 0.0;
        if (straight && background && parameters.film_transparent != 0u)
            seen.a -= (path.throughput.r + path.throughput.g + path.throughput.b) / 3.0;
        else {
            float share = scattered_share(path.scatter_density, environment_shadow_ray_pdf(ray.direction));
            seen.rgb += path.throughput * (straight ? world_radiance_seen(ray.direction)
                                           : world_radiance(ray.direction)) * share;
        }
        radiances[index] += seen;
        return;
    }
    path.throughput *= segment_transmittance(path.flags, closure);
    if ((closure.flags & CLOSURE_CATCHES_SHADOWS) != 0u) path.throughput *= float(lit_catchers[index]);
    vec3 geometric = unpack_unit_vector(closure.geometric_normal);
    if (largest(closure.emission) > 0.0 && !gathered) {
        float share = 1.0;
        if (path.scatter_density > 0.0)
            share = scattered_share(path.scatter_density, emissive_triangle_density(ray.origin, closure.triangle));
        seen.rgb += path.throughput * closure.emission * share;
    }
    if (straight)
        seen.a -= closure_holdout(closure) * (path.throughput.r + path.throughput.g + path.throughput.b) / 3.0;
    radiances[index] += seen;

    vec3 viewer = -ray.direction;
    path.total_length += closure.distance;
    bool parallel = camera.projection == PROJECTION_ORTHOGRAPHIC;
    if (parameters.segment == 0u) {
        // Eq. 3: radius of the disk that a pixel's footprint covers, times the scale.
        float facing = max(abs(dot(geometric, ray.direction)), 1e-4);
        path.primary_distance = path.total_length;
        path.primary_radius *= parameters.radius_scale * (parallel ? 1.0 : path.primary_distance) / sqrt(facing);
    }
    // Eq. 4, with the limits that shrink as the radius does. Parallel rays stay as far apart as they are.
    float growth = parallel ? 1.0 : path.total_length / max(path.primary_distance, 1e-12);
    float radius = path.primary_radius * growth;
    radius = parameters.shrinkage * clamp(radius, parameters.radius_minimum, parameters.radius_maximum);
    float factor = parameters.iteration <= 1u ? parameters.most_radius_factor
                   : radius_factors[parameters.first_pixel + index];
    float caustic_radius = gathered ? max(radius, parameters.radius_by_ray) : factor * radius;

    // A pixel's choices are spread evenly over the iterations: a seldom one comes neither in a row nor never.
    uvec4 choices = pcg4d(uvec4(parameters.first_pixel + index, parameters.segment, parameters.seed,
                                STAGE_IMPORTONS << 24u));
    vec2 u_lobe = scrambled_sobol(parameters.iteration - 1u, choices);
    bool gathers = parameters.final_gather != 0u && parameters.last_segment == 0u
                && path_gathers(path.flags, closure.distance, parameters.gathers_again_below);
    importons[index] = make_importon(closure, path.throughput, viewer, caustic_radius, u_lobe.y,
                                     (gathers ? GATHERS_BY_RAY : 0u) | (gathered ? GATHERED_BY_RAY : 0u));

    if (parameters.last_segment != 0u) return;
    vec4 shares = camera_path_shares(closure, path.throughput, viewer, parameters.specular_alpha, false);
    vec4 gathering_shares = vec4(0.0);
    if (gathers)
        gathering_shares = camera_path_shares(closure, path.throughput, viewer, parameters.specular_alpha, true);
    float gathering = sum(gathering_shares), total = sum(shares) + gathering;
    if (total <= 0.0) return;
    float survival = path_survival(total);
    float u = u_lobe.x;
    if (u >= survival) return;
    vec2 u_direction = scrambled_sobol(parameters.iteration - 1u, pcg4d(choices));
    float u_event = scrambled_sobol(parameters.iteration - 1u, pcg4d(choices + 1u)).x;
    u *= total / survival;
    vec3 direction, weight;
    bool transmitted;
    float probability, straight_density = path.scatter_density;
    path.scatter_density = 0.0;
    bool sets_out = u < gathering;
    if (sets_out) {
        path.flags = (path.flags & ~PATH_STRAIGHT) | PATH_GATHERED | (gathered ? PATH_GATHERED_AGAIN : 0u);
        shares = gathering_shares;
    } else u -= gathering;
    bool diffuse = sets_out && u < shares.x;
    vec3 normal = unpack_unit_vector(closure.diffuse_normal), found_weight = vec3(1.0);
    if (diffuse) {
        float reflected = largest(path.throughput * closure.diffuse);
        transmitted = u >= reflected;
        probability = transmitted ? shares.x - reflected : reflected;
        if (transmitted) normal = -normal;
        direction = sample_cosine_hemisphere(normal, u_direction);
        weight = transmitted ? closure.translucent : closure.diffuse;
        found_weight = diffuse_factor(closure, transmitted ? -normal : normal, viewer, direction);
        path.scatter_density = probability * survival / total * max(dot(normal, direction), 0.0) / PI;
    } else if (u < shares.x) {
        direction = ray.direction;
        weight = closure.transparent;
        if ((closure.flags & CLOSURE_SHADOWLESS) == 0u) path.flags |= PATH_CAUSTIC;
        else path.scatter_density = straight_density;  // shadow rays pass as well
        transmitted = true;
        probability = shares.x;
    } else {
        u -= shares.x;
        int chosen = u < shares.y ? 0 : (u < shares.y + shares.z ? 1 : 2);
        probability = shares[1 + chosen];
        if (probability <= 0.0) return;
        MicrofacetLobe lobe = closure_lobe(closure, chosen);
        normal = lobe_normal(lobe);
        LobeSample sampled = sample_lobe(lobe, normal, viewer, u_direction, u_event, true);
        if (parameters.next_event != 0u && lobe_stores(lobe, SMOOTHEST_LIT))
            path.scatter_density = lobe_probability(shares, total, chosen)
                                   * lobe_density(lobe, normal, viewer, sampled.direction);
        direction = sampled.direction;
        weight = sampled.weight * lobe_shadowing(lobe, closure.shading_normal, sampled.direction);
        transmitted = sampled.transmitted;
        path.flags = (path.flags & ~(PATH_STRAIGHT | PATH_DIFFUSE | PATH_TRANSMITTED | PATH_SINGULAR)) | PATH_CAUSTIC;
        if (transmitted) path.flags |= PATH_TRANSMITTED;
        if (lobe.alpha <= SMOOTHEST_LIT) path.flags |= PATH_SINGULAR;
    }
    if (diffuse) path.flags = (path.flags & ~(PATH_TRANSMITTED | PATH_SINGULAR)) | PATH_DIFFUSE;
    path.throughput *= weight * (total / (probability * survival));
    if (sets_out) path.flags &= ~PATH_CAUSTIC;
    if (sets_out && gathered) {
        gathering_vertices[index].radius = caustic_radius;
        path.throughput *= found_weight;
    } else if (sets_out) {
        // Rough lobes see in directions of their own, and diffuse ones all alike: those share what they find.
        gathering_vertices[index] = GatheringVertex(closure.position, diffuse ? radius : 0.0, path.throughput,
                                                    pack_unit_vector(normal),
                                                    vec3(0.0), caustic_radius);
        path.throughput = found_weight;
    }
    float side = dot(direction, geometric);
    if (!(largest(path.throughput) > 0.0) || (transmitted ? side >= 0.0 : side <= 0.0)) return;
    if (transmitted) path.flags = cross_surface(path.flags, closure);
    camera_paths[index] = path;
    vec3 origin = offset_from_surface(closure.position, side > 0.0 ? geometric : -geometric);
    rays[index] = Ray(origin, closure.triangle, direction, INFINITY_DISTANCE);
}
