#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint:
// lint: HAIR_LOBES=1
// lint: ASHIKHMIN_LOBES=1
// lint: PORTALS=1
// TraceImportons: collect what a camera path sees shine, leave an importon for the lobes that store
// photons, and go on by the specular ones.

layout(local_size_x = 64) in;

#include <ScatterImportonsParameters>
#include "common/iteration.glsl"
#include "common/active_paths.glsl"
#include "common/low_discrepancy.glsl"
#include "common/bsdf/closure.glsl"
#include "common/camera_path.glsl"
#include "common/transparency.glsl"
#include "common/gathering.glsl"
#include "common/path_history.glsl"
#include "common/world_light.glsl"
readonly buffer Materials;
#include "materials/medium.glsl"
uniform Parameters { ScatterImportonsParameters parameters; };
#include "lights/light_tree.glsl"
readonly buffer Closures;
#include "common/bsdf/stored_lobes.glsl"
buffer Rays;
buffer CameraPaths;
buffer Importons;
readonly buffer CatcherVisibility;
buffer GatheringVertices;
buffer Radiances;
readonly buffer Camera;
readonly buffer RadiusFactors;
#include "camera_paths/importons/radius.glsl"
#include "camera_paths/importons/round_shapes.glsl"
#include "camera_paths/importons/scattered_at.glsl"
#include "camera_paths/importons/scatter_point.glsl"

// What does not wait for the lobe is written first: beside one, processors have no registers for all of an importon.
void leave_importon(uint index, Closure closure, vec3 throughput, vec3 viewer, vec4 shares, float least_radius,
                    float radius, float u, uint gathers, uint history, uint depth) {
    vec3 diffuse = throughput * closure.diffuse / PI, translucent = throughput * closure.translucent / PI;
    importons[index].position = closure.position;
    importons[index].direction = viewer;
    importons[index].geometric_normal = closure.geometric_normal;
    importons[index].diffuse = diffuse;
    importons[index].diffuse_normal = closure.diffuse_normal;
    importons[index].translucent = translucent;
    importons[index].diffuse_roughness = closure.diffuse_roughness;
    importons[index].next = 0u;
    importons[index].gathers = gathers;
    importons[index].shading_normal = closure.shading_normal;
    importons[index].least_radius = least_radius;
    importons[index].history = history_word(history, history, depth);
    // One rough lobe stands for all of them, chosen by its albedo.
    float total = 0.0;
    int chosen = -1;
    for (int k = 0; k < closure_lobes(closure); ++k) {
        float share = shares[1 + k];
        if (!(share > 0.0)) continue;
        total += share;
        if (reservoir_accept(share, total, u)) chosen = k;
    }
    ClosureLobe lobe = EMPTY_LOBE;
    if (chosen >= 0) {
        lobe = closures[index].lobes[max(chosen, 0)];
        float share = shares[1 + max(chosen, 0)];
        lobe.weight = throughput * lobe.weight / share * total;
        if (passes_by_f0(unpack_kind(lobe.kind))) lobe.f0 = throughput * lobe.f0 / share * total;
    }
    bool stores = unpack_kind(lobe.kind) != LOBE_NONE || !(largest(diffuse + translucent) <= 0.0);
    importons[index].radius = stores ? radius : 0.0;
    importons[index].lobe_weight = lobe.weight;
    importons[index].lobe_kind = lobe.kind;
    importons[index].lobe_f0 = lobe.f0;
    importons[index].lobe_alpha = lobe.alpha;
    importons[index].lobe_ior = lobe.ior;
    importons[index].lobe_normal = lobe.normal;
    importons[index].lobe_anisotropy = lobe.anisotropy;
}

// How a ray and shadow rays from where it began find the environment: the pdf of these in 1/sr, as photons know it and
// as it is at that place; and whether neighbors share what the ray finds.
struct EnvironmentView {
    float plain_pdf;
    float pdf;
    bool is_shared;
};

// An even environment is left to rays, but for what comes through portals. Neighbors share it: its shadows are as soft
// as those of indirect light.
// start: where the ray was scattered.
EnvironmentView view_environment(vec3 start, Ray ray) {
    float plain_pdf = world_shadow_ray_pdf(ray.direction);
    bool left_to_rays = iteration.final_gather != 0u && environment_is_even();
    EnvironmentView view = EnvironmentView(plain_pdf, left_to_rays ? 0.0 : plain_pdf, environment_is_even());
#ifdef PORTALS
    PortalView portals = view_portals(start, ray.direction, NO_PORTAL);
    if (portals.solid_angle > 0.0) view.pdf = iteration.world_selection * mixed_world_pdf(portals, ray.direction);
    if (portals.pdf > 0.0) {
        view.plain_pdf = ONLY_SHADOW_RAYS;
        view.is_shared = false;
    }
#endif
    return view;
}

// The share that a ray has of the environment that shadow rays from its vertex find as well.
float environment_weight(CameraPath path, EnvironmentView view) {
    return scatter_mis_weight(path.scatter_pdf, view.pdf);
}

// Radiance of the world for a path that comes to no surface. What gathering rays find lights the surface before; what
// others see is no matter of bounces, as in Cycles.
vec3 found_world(uint flags, uint depth, vec3 direction) {
    bool gathered = (flags & PATH_GATHERED) != 0u;
    if ((camera_ray_kind(flags) & iteration.world_visibility & RAYS_WITH_VISIBILITY) == 0u
        || (gathered && bounces_of(depth) > iteration.world_bounces + 1u))
        return vec3(0.0);
    return world_radiance(direction, (flags & PATH_CAMERA_TRANSPARENT) != 0u && !gathered);
}

// What shines at the end of a gathering ray is direct light where the ray began, or a caustic there, which is left to
// photons but for the environment's. Shadow rays find direct light, and share the environment's with this ray.
void end_gathering_ray(uint index, CameraPath path, vec3 world, EnvironmentView view) {
    if ((path.flags & PATH_CAUSTIC) == 0u) {
        if (iteration.next_event == 0u) return;
        vec3 arrived = path.throughput * world * environment_weight(path, view);
        arrived *= 1.0 - direct_photon_share(world, view.plain_pdf, gathering_vertices[index].radius);
        bool is_shared = (path.flags & PATH_GATHERED_AGAIN) != 0u || view.is_shared;
        if (is_shared) gathering_vertices[index].found += arrived;
        else radiances[index].rgb += gathering_vertices[index].weight * arrived;
        return;
    }
    float photons = world_photon_share(largest(world), iteration.photon_flux, gathering_vertices[index].radius);
    gathering_vertices[index].found += path.throughput * world * (1.0 - photons);
}

// Radiance and alpha of what lies behind everything. background: no light object was passed.
vec4 seen_environment(CameraPath path, vec3 world, EnvironmentView view, bool background) {
    if ((path.flags & PATH_CAMERA_TRANSPARENT) != 0u && background && iteration.film_transparent != 0u)
        return vec4(vec3(0.0), -(path.throughput.r + path.throughput.g + path.throughput.b) / 3.0);
    return vec4(path.throughput * world * environment_weight(path, view), 0.0);
}

// Share that a ray has of the light of a surface that shadow rays from where it was scattered find as well.
float emission_weight(ScatterPoint from, uint triangle) {
    if (!(from.pdf > 0.0)) return 1.0;
    float pdf = emissive_triangle_pdf(from.lit.position, triangle);
    uint leaf = uint(triangle_vertices[3u * triangle + 1u].w);
    if (pdf > 0.0 && leaf > 0u) pdf *= light_probability(from.lit, from.environment_irradiance, KIND_TRIANGLES, leaf);
    else pdf = 0.0;
    return scatter_mis_weight(from.pdf, pdf);
}

// Radiance and alpha of a surface that shines by itself or cuts a hole.
vec4 seen_surface(CameraPath path, ScatterPoint from, Closure closure) {
    vec4 seen = vec4(0.0);
    uint traits = emitter_traits(closure.triangle);
    bool is_found = (path.flags & PATH_LIGHTS_FOUND) != 0u && (traits & EMITTER_REFLECTED) != 0u;
    bool is_left = from.gathers && (iteration.gathers_lights == 0u || traits >> EMITTER_LINK_SHIFT != 0u);
    if (largest(closure.emission) > 0.0 && path_sees_lights(path, iteration.next_event) && !is_found && !is_left)
        seen.rgb = path.throughput * closure.emission * emission_weight(from, closure.triangle);
    if ((path.flags & PATH_CAMERA_TRANSPARENT) != 0u)
        seen.a = -(closure_holdout(closure) * (path.throughput.r + path.throughput.g + path.throughput.b) / 3.0);
    return seen;
}

// Radiance of the light objects on a path's way.
vec3 passed_radiance(CameraPath path, ScatterPoint from, Ray ray, float way) {
    if (!path_sees_lights(path, iteration.next_event) || (path.flags & PATH_LIGHTS_FOUND) != 0u) return vec3(0.0);
    return visible_light(from, ray, way, camera_ray_kind(path.flags), path_absorption(path.flags));
}

// What the media on a path's way weaken, and what they shine themselves, which surfaces that gather find as well.
// Returns the throughput before the way.
vec3 pass_media(uint index, inout CameraPath path, float way) {
    vec3 departing = path.throughput;
    if (path.flags >> FIRST_MEDIUM == 0u) return departing;
    vec3 shining = departing * segment_emission(path.flags, way);
    if ((path.flags & PATH_GATHERED) != 0u) gathering_vertices[index].found += shining;
    else radiances[index].rgb += shining;
    path.throughput *= segment_transmittance(path.flags, way);
    return departing;
}

// Of neighbors' gathering rays that came to no surface, none may tell the other's direction from its own.
const float FAR_RADII = 1e4;

// How a path may go on.
struct Event {
    vec3 direction;
    vec3 weight;
    vec3 normal;        // of a diffuse one on the side of the direction
    float probability;  // of those that all shares stand for
    bool transmitted;
    float pdf;   // in 1/sr, where shadow rays sample the same light; else 0
    uint flags;  // of the path from here on
    uint scatter;
};

Event diffuse_event(CameraPath path, Closure closure, float u, vec2 disk, vec4 shares, float total, float survival) {
    Event event;
    float reflected = largest(path.throughput * closure.diffuse);
    event.transmitted = u >= reflected;
    event.probability = event.transmitted ? shares.x - reflected : reflected;
    event.normal = unpack_unit_vector(closure.diffuse_normal);
    if (event.transmitted) event.normal = -event.normal;
    event.direction = cosine_hemisphere(event.normal, disk);
    event.weight = event.transmitted ? closure.translucent : closure.diffuse;
    event.pdf = event.probability * survival / total * max(dot(event.normal, event.direction), 0.0) / PI;
    event.flags =
        (path.flags & ~(PATH_TRANSMITTED | PATH_SINGULAR | PATH_LIGHTS_FOUND | PATH_SEEN_THROUGH)) | PATH_DIFFUSE;
    event.scatter = SCATTER_DIFFUSE;
    return event;
}

Event straight_event(CameraPath path, Closure closure, vec3 direction, vec4 shares) {
    bool shadow_rays_pass = (closure.flags & CLOSURE_SHADOWLESS) != 0u;
    return Event(direction, closure.transparent, -direction, shares.x, true, shadow_rays_pass ? path.scatter_pdf : 0.0,
                 shadow_rays_pass ? path.flags | (path.scatter_pdf > 0.0 ? PATH_SEEN_THROUGH : 0u)
                                  : (path.flags & ~(PATH_LIGHTS_FOUND | PATH_SEEN_THROUGH)) | PATH_CAUSTIC,
                 SCATTER_NONE);
}

// u: behind the share of what is no lobe.
Event lobe_event(uint index, CameraPath path, Closure closure, vec3 viewer, float u, vec2 disk, float u_event,
                 vec4 shares, LobeSelection all) {
    Event event;
    int chosen = u < shares.y ? 0 : (u < shares.y + shares.z ? 1 : 2);
    event.probability = shares[1 + chosen];
    MicrofacetLobe lobe = stored_lobe(index, chosen);
    event.normal = lobe_normal(lobe);
    LobeSample sampled = sample_lobe(lobe, event.normal, viewer, disk, u_event, true);
    event.pdf = 0.0;
    if (iteration.next_event != 0u && lobe.kind != LOBE_NONE && lobe.alpha > MIN_MIS_ALPHA)
        event.pdf = part_probability(event.probability, all) * lobe_pdf(lobe, event.normal, viewer, sampled.direction);
    event.direction = sampled.direction;
    event.weight = sampled.weight * lobe_shadowing(lobe, closure.shading_normal, sampled.direction);
    if (lobe_is_hair(lobe.kind))
        sampled.transmitted = dot(sampled.direction, unpack_unit_vector(closure.geometric_normal)) < 0.0;
    event.transmitted = sampled.transmitted;
    event.scatter = lobe_scatter(lobe.kind, sampled.transmitted);
    bool lights_found = iteration.next_event != 0u && !sampled.transmitted
                        && looks_for_reflected_lights(lobe, shares, all.total, chosen, viewer,
                                                      min(MIN_MIS_ALPHA, iteration.specular_alpha));
    event.flags = (path.flags
                   & ~(PATH_CAMERA_TRANSPARENT | PATH_DIFFUSE | PATH_TRANSMITTED | PATH_SINGULAR | PATH_LIGHTS_FOUND
                       | PATH_SEEN_THROUGH))
                  | PATH_CAUSTIC | (sampled.transmitted ? PATH_TRANSMITTED : 0u)
                  | (lobe.alpha <= MIN_MIS_ALPHA ? PATH_SINGULAR : 0u) | (lights_found ? PATH_LIGHTS_FOUND : 0u)
                  | dispersed_flag(closure, lobe, sampled.transmitted);
    return event;
}

// Behind the last bounce a path only comes through transparent surfaces.
LobeSelection limited_shares(LobeSelection shares, uint bounces, bool is_seen) {
    float straight = shares.specular.x;
    if (bounces <= iteration.camera_bounces) return shares;
    return LobeSelection(vec4(straight, 0.0, 0.0, 0.0), vec4(0.0), straight, path_survival(straight, is_seen));
}

// What a path remembers of how it goes on.
void take_event(uint index, inout CameraPath path, Closure closure, Event event, bool gathers) {
    path.flags = event.flags;
    if (event.scatter != SCATTER_NONE) path.depth += ONE_BOUNCE;
    else if (counts_as_transparent(closure)) path.depth += ONE_TRANSPARENT;
    path.straight_length = event.scatter == SCATTER_NONE ? path.straight_length + closure.distance : 0.0;
    path.scatter_pdf = event.pdf;
    if (event.scatter != SCATTER_NONE && event.pdf > 0.0) {
        path.lit_normal = closure.shading_normal;
        path.lit_from = pack_lit_from(light_set_at(closure.triangle), lit_from_behind(index, closure), gathers);
    }
}

const float NO_REACH = 1e-30;  // of a ray that goes on and meets nothing

// The next ray of a path that survives. choices: numbers for the lobe, a place on its disk, and what the lobe does.
void sample_next_ray(uint index, CameraPath path, Ray ray, Closure closure, LobeSelection all, bool gathers,
                     float radius, float disk, vec4 choices, uint history) {
    vec3 viewer = -ray.direction;
    float gathering = gathers ? sum(all.stored) : 0.0, total = all.total;
    if (total <= 0.0) return;
    float survival = all.survival, u = choices.x, u_event = choices.w;
    if (u >= survival) return;
    vec2 on_disk = sample_disk(choices.yz);
    u *= total / survival;
    bool sets_out = u < gathering, gathered = (path.flags & PATH_GATHERED) != 0u;
    if (sets_out) {
        path.flags = (path.flags & ~PATH_CAMERA_TRANSPARENT) | PATH_GATHERED | (gathered ? PATH_GATHERED_AGAIN : 0u);
    } else u -= gathering;
    vec4 shares = sets_out ? all.stored : all.specular;
    Event event;
    bool diffuse = sets_out && u < shares.x;
    vec3 found_weight = vec3(1.0);
    // Lobes first, since they need most registers: what else there is would be kept beside.
    if (!diffuse && !(u < shares.x))
        event = lobe_event(index, path, closure, viewer, u - shares.x, on_disk, u_event, shares, all);
    else if (diffuse) {
        event = diffuse_event(path, closure, u, on_disk, shares, total, survival);
        vec3 facing = event.transmitted ? -event.normal : event.normal;
        found_weight = diffuse_factor(closure, facing, viewer, event.direction, !event.transmitted)
                       * terminator_factor(closure.flags, facing, event.direction);
    } else event = straight_event(path, closure, ray.direction, shares);
    if (event.probability <= 0.0) return;
    importons[index].history = history_word(history, scattered_history(history, event.scatter), path.depth);
    take_event(index, path, closure, event, gathers);
    path.throughput *= event.weight * (total / (event.probability * survival));
    // What a gathering ray finds serves neighbors, of other wavelengths: it begins white.
    if (sets_out) path.flags &= ~(PATH_CAUSTIC | PATH_DISPERSED);
    if (sets_out && gathered) {
        gathering_vertices[index].radius = disk;
        path.throughput *= found_weight;
    } else if (sets_out) {
        // Rough lobes see in directions of their own, and diffuse ones all alike: those share what they find.
        gathering_vertices[index] = GatheringVertex(
            closure.position, diffuse ? radius : 0.0, path.throughput, pack_unit_vector(event.normal), vec3(0.0), disk,
            closure.position + FAR_RADII * radius * event.direction, pack_unit_vector(-event.direction));
        path.throughput = found_weight;
    } else if (!gathered && event.scatter != SCATTER_NONE) gathering_vertices[index].position = closure.position;
    vec3 geometric = unpack_unit_vector(closure.geometric_normal);
    float side = dot(event.direction, geometric);
    if (!(largest(path.throughput) > 0.0) || (event.transmitted ? side >= 0.0 : side <= 0.0)) return;
    if (event.transmitted) path.flags = cross_surface(path.flags, closure.material, closure_backfacing(closure));
    camera_paths[index] = path;
    float offset = closures[index].ray_offset;
    vec3 origin = closure.position + (side > 0.0 ? offset : -offset) * geometric;
    // Behind a catcher only the world is seen.
    float reach = (closure.flags & CLOSURE_CATCHES_SHADOWS) != 0u ? NO_REACH : INFINITY_DISTANCE;
    rays[index] = Ray(origin, closure.triangle, event.direction, reach);
}

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    CameraPath path = camera_paths[index];
    Ray ray = rays[index];
    uint history = parameters.segment == 0u ? 0u : departing_history(importons[index].history);
    importons[index].radius = 0.0;
    rays[index].maximum_distance = 0.0;
    if (parameters.segment == 0u) {
        gathering_vertices[index].shared_radius = -1.0;
        importons[index].history = 0u;
    }
    if (!(ray.maximum_distance > 0.0)) return;
    bool hit = closures[index].triangle != NO_TRIANGLE, gathered = (path.flags & PATH_GATHERED) != 0u;
    vec3 world = vec3(0.0), start = scattered_at(index, path, ray);
    EnvironmentView view = EnvironmentView(0.0, 0.0, false);
    if (!hit) {
        world = found_world(path.flags, path.depth, ray.direction);
        view = view_environment(start, ray);
    }
    float way = hit ? closures[index].distance : INFINITY_DISTANCE;
    vec3 departing = pass_media(index, path, way);
    ScatterPoint from = scatter_point(path, ray, start);
    vec3 lights_passed = passed_radiance(path, from, ray, way);
    vec4 seen = vec4(departing * lights_passed, 0.0);
    vec3 weight = gathered ? gathering_vertices[index].weight : vec3(1.0);
    if (!hit) {
        if (!gathered) seen += seen_environment(path, world, view, largest(lights_passed) <= 0.0);
        radiances[index] += vec4(weight, 1.0) * seen;
        if (gathered) end_gathering_ray(index, path, world, view);
        return;
    }
    Closure closure = closures[index];
    if ((closure.flags & CLOSURE_CATCHES_SHADOWS) != 0u) path.throughput *= float(catcher_visibility[index]);
    radiances[index] += vec4(weight, 1.0) * (seen + seen_surface(path, from, closure));
    float radius = vertex_radius(path, ray.direction, closure), most = caustic_radius_of(index, radius, gathered);
    // A pixel's choices are spread evenly over the iterations: a seldom one comes neither in a row nor never.
    uvec4 choices =
        pcg4d(uvec4(parameters.first_pixel + index, parameters.segment, iteration.seed, STAGE_IMPORTONS << 24u));
    vec4 u_lobe = scrambled_sobol4(iteration.number - 1u, choices).zxyw;
    float u_importon = scrambled_sobol(iteration.number - 1u, pcg4d(choices)).x;
    uint bounces = bounces_of(path.depth);
    bool is_seen = (path.flags & PATH_CAMERA_TRANSPARENT) != 0u;
    if (!may_pass(closure, path.depth, iteration.transparent_max_bounces)) closure.transparent = vec3(0.0);
    bool gathers = iteration.final_gather != 0u && bounces < iteration.camera_bounces
                   && path_gathers(path.flags, length_to_gather_by(closure), iteration.gathers_again_below);
    LobeSelection shares = limited_shares(
        path_shares(index, closure, path.throughput, -ray.direction, iteration.specular_alpha, gathers, is_seen),
        bounces, is_seen);
    if (gathered && (path.flags & (PATH_CAUSTIC | PATH_GATHERED_AGAIN)) == 0u && sum(shares.stored) > 0.0) {
        gathering_vertices[index].hit = closure.position;
        gathering_vertices[index].hit_normal = closure.geometric_normal;
    }
    float least_radius = gathered ? most : radius;
    leave_importon(index, closure, path.throughput, -ray.direction, shares.stored, least_radius,
                   bounces > iteration.camera_bounces ? 0.0 : most, u_importon,
                   (gathers ? FINAL_GATHER_ORIGIN : 0u) | (gathered ? FINAL_GATHER_HIT : 0u), history, path.depth);
    sample_next_ray(index, path, ray, closure, shares, gathers, radius, disk_radius(least_radius, most), u_lobe,
                    history);
}
