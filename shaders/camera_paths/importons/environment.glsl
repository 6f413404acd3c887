// SPDX-License-Identifier: GPL-3.0-or-later
// Rays of camera paths that escape to the environment.
// The includer includes camera_paths/importons/emission.glsl before.

// Sampling of the environment by shadow rays from the origin of a ray, in the ray's direction.
struct EnvironmentSampling {
    float pdf;       // 1/sr, 0 where rays alone bring the environment
    bool is_reused;  // whether neighboring pixels reuse the radiance
};

// Rays alone bring an even environment to a final gather, but for light through portals. Neighbors reuse that: its
// shadows are as soft as those of indirect light.
EnvironmentSampling environment_sampling(vec3 position, vec3 direction) {
    bool rays_alone = iteration.final_gather != 0u && environment_is_even();
    EnvironmentSampling sampling =
        EnvironmentSampling(rays_alone ? 0.0 : world_shadow_ray_pdf(direction), environment_is_even());
#ifdef PORTALS
    PortalView portals = view_portals(position, direction, NO_PORTAL);
    if (portals.solid_angle > 0.0) sampling.pdf = iteration.world_selection * mixed_world_pdf(portals, direction);
    if (portals.pdf > 0.0) sampling.is_reused = false;
#endif
    return sampling;
}

// Radiance of the environment for an escaped ray. It lights the origin of a final gather as a bounce, which the
// environment may limit. Other rays see it at any depth, as in Cycles.
vec3 environment_radiance(CameraPath path, vec3 direction) {
    bool gathers = is_final_gather(path);
    if ((camera_ray_kind(path.flags) & iteration.world_visibility & RAYS_WITH_VISIBILITY) == 0u
        || (gathers && bounces_of(path.depth) > iteration.world_bounces + 1u))
        return vec3(0.0);
    bool by_camera = (path.flags & PATH_CAMERA_TRANSPARENT) != 0u || iteration.environment_is_fine != 0u;
    return world_radiance(direction, by_camera && !gathers);
}

// Radiance and alpha of the environment as a background or a reflection. A transparent film leaves it out where the
// camera sees it and no light object is in front.
vec4 background_radiance(CameraPath path, vec3 environment, float shadow_ray_pdf, bool is_covered) {
    if (sees_background(path.flags) && !is_covered && iteration.film_transparent != 0u)
        return vec4(vec3(0.0), -(path.throughput.r + path.throughput.g + path.throughput.b) / 3.0);
    return vec4(path.throughput * environment * scatter_mis_weight(path.scatter_pdf, shadow_ray_pdf), 0.0);
}

#ifdef MEDIA
// The environment at the end of a ray that a medium has scattered, which shadow rays from there bring as well where it
// is uneven.
void gather_environment_in_medium(PathSegment segment, vec3 environment, float shadow_ray_pdf) {
    CameraPath path = segment.path;
    if ((path.flags & PATH_CAUSTIC) != 0u || !(path.scatter_pdf > 0.0)) return;
#ifdef PORTALS
    return;
#endif
    radiances[segment.index].rgb +=
        clamped_light(path.throughput * environment * scatter_mis_weight(path.scatter_pdf, shadow_ray_pdf),
                      bounces_of(path.depth) - 1u);
}
#endif

// The environment at the end of a final gather's ray is direct light at its origin, which shadow rays bring as well, or
// a caustic there, which photons bring as well. Each technique has its MIS weight.
void gather_environment(PathSegment segment, vec3 environment, EnvironmentSampling sampling) {
    uint index = segment.index;
    CameraPath path = segment.path;
    if (is_behind_ray_portal(path)) {
        add_radiance(segment, vec4(path.throughput * environment, 0.0));
        return;
    }
#ifdef MEDIA
    if (is_medium_gather(path)) {
        gather_environment_in_medium(segment, environment, sampling.pdf);
        return;
    }
#endif
    if ((path.flags & PATH_CAUSTIC) == 0u) {
        if (iteration.next_event == 0u) return;
        vec3 direct = path.throughput * environment * scatter_mis_weight(path.scatter_pdf, sampling.pdf);
        bool is_reused = is_secondary_gather(path) || sampling.is_reused;
        if (is_reused) final_gather_hits[index].radiance += direct;
        else radiances[index].rgb += clamped_light(final_gather_origins[index].weight * direct, 0u);
        return;
    }
    float photon_weight = photon_power_heuristic(largest(environment), iteration.photon_flux, path.photon_radius);
    final_gather_hits[index].radiance += path.throughput * environment * (1.0 - photon_weight);
}

// lights: radiance of the light objects that the ray intersects.
void handle_escaped(PathSegment segment, vec3 lights) {
    vec3 direction = segment.ray.direction, environment = environment_radiance(segment.path, direction);
    EnvironmentSampling sampling = environment_sampling(segment.from.lit.position, direction);
    vec4 radiance = vec4(segment.origin_throughput * lights, 0.0);
    if (!is_final_gather(segment.path))
        radiance += background_radiance(segment.path, environment, sampling.pdf, !(largest(lights) <= 0.0));
    add_radiance(segment, radiance);
    if (is_final_gather(segment.path)) gather_environment(segment, environment, sampling);
}
