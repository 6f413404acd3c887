#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint: MEDIA=1
// lint: MEDIA=1 HETEROGENEOUS_MEDIA=1
// lint: MEDIA=1 PORTALS=1
// lint: MEDIA=1 RAY_PORTALS=1
// lint: MEDIA=1 EMITTERS=lights/two_levels
// lint: MEDIA=1 HETEROGENEOUS_MEDIA=1 EMITTERS=lights/two_levels
// Shadow rays from points in scattering media, one on each camera ray: light that is scattered once. The point is
// sampled as the media scatter light, or by the angle at which the light sees the ray (Kulla and Fajardo 2012,
// Importance Sampling Techniques for Path Tracing in Participating Media); MIS combines both.

layout(local_size_x = 64) in;

#include <DirectLightParameters>
#include "common/iteration.glsl"
#include "common/active_paths.glsl"
#include "common/low_discrepancy.glsl"
#include "common/bsdf/closure.glsl"
#include "common/camera_path.glsl"
#include "common/path_depth.glsl"
readonly buffer Media;
#include "materials/medium.glsl"
uniform Parameters { DirectLightParameters parameters; };
#include "lights/light_tree.glsl"
#include "common/phase_functions.glsl"
#include "media/free_flight.glsl"
#include "media/in_scattering/spot_cone.glsl"
#include "media/medium_gather.glsl"
readonly buffer Rays;
readonly buffer CameraPaths;
readonly buffer MediumVertices;
writeonly buffer ShadowRays;
writeonly buffer LightTriangles;
writeonly buffer Contributions;
writeonly buffer LightSplits;
writeonly buffer ShadowMedia;
#include EMITTERS "lights/one_level/hits.glsl"

// The part of a ray on which light is scattered, and how.
struct MediumSegment {
    Ray ray;
    float far;
    uint flags;      // of the path
    vec3 thickness;  // of the media along the whole ray
};

// Equiangular sampling: the angle at which a point sees the points of a segment is even.
struct Equiangular {
    float nearest;  // distance along the ray of the point that is nearest to the light, meters
    float height;   // of the light above the ray, meters
    float first;    // angles, radians
    float last;
};

Equiangular equiangular(MediumSegment segment, vec3 center, vec2 range) {
    float nearest = dot(center - segment.ray.origin, segment.ray.direction);
    float height = max(length(center - segment.ray.origin - nearest * segment.ray.direction), 1e-6);
    return Equiangular(nearest, height, atan(range.x - nearest, height), atan(range.y - nearest, height));
}

float equiangular_distance(Equiangular angles, float u) {
    return angles.nearest + angles.height * tan(mix(angles.first, angles.last, u));
}

float equiangular_pdf(Equiangular angles, float distance) {
    float along = distance - angles.nearest, angle = atan(along, angles.height);
    if (angle < angles.first - 1e-6 || angle > angles.last + 1e-6) return 0.0;
    return angles.height / (max(angles.last - angles.first, 1e-20) * (angles.height * angles.height + along * along));
}

void leave_no_light(uint index) {
    shadow_rays[index].maximum_distance = 0.0;
    contributions[index] = vec4(0.0);
    light_triangles[index] = NO_TRIANGLE;
}

LitPoint lit_point(vec3 position) { return LitPoint(position, vec3(0.0), true, 0u); }

// The place of a light, about which points are sampled by their angle.
vec3 light_center(Light light, EmitterNumber emitter) {
    if (light.kind != LIGHT_MESH) return light.position;
    vec3 v0, v1, v2;
    EmitterNumber triangle;
    read_emitter(emitter, triangle, v0, v1, v2);
    return (v0 + v1 + v2) / 3.0;
}

// Pdf of a distance by both techniques, each taken for half of the points, 1/m; of lights without a place, by the
// first. transmittance: up to the distance.
float distance_pdf(MediumSegment segment, bool has_place, Equiangular angles, float distance, out vec3 transmittance) {
    float pdf =
        scattered_flight_pdf(segment.flags, segment.ray, segment.far, distance, segment.thickness, transmittance);
    return has_place ? 0.5 * (pdf + equiangular_pdf(angles, distance)) : pdf;
}

// Whether the ray by which a path goes on meets the environment as well: the media scatter the path.
bool meets_environment(CameraPath path) {
#ifdef PORTALS
    return false;
#else
    return path.medium_passing < 1.0;
#endif
}

// MIS weight of a shadow ray to the environment, which a path that the media scatter meets as well; pdf: of the shadow
// ray among those to the environment, 1/sr.
float world_mis_weight(CameraPath path, PlaceOnRay at, vec3 scattered, Light light, float pdf) {
    if (!meets_environment(path)) return 1.0;
    vec3 scattering = path_medium(path.flags, at).scattering;
    float phase_pdf = dot(scattered, vec3(1.0)) / max(dot(scattering, vec3(1.0)), 1e-30);
    return power_heuristic(pdf * light.selection_probability, phase_pdf);
}

#ifndef PORTALS
// The same light in a direction of the phase function, for half of the points where the environment is uneven (balance
// heuristic): no other ray meets it. at: the point. u: chooses the technique, and the direction.
LightSample sample_world_by_phase(LightSample sampled, CameraPath path, PlaceOnRay at, vec3 u) {
    bool is_even = environment_is_even();
    if (is_even || u.x < 0.5) {
        PhaseFunction phase = sample_path_phase_function(path.flags, at, vec3(1.0), u.y);
        sampled.direction = direction_around(at.direction, sample_phase_function(phase, u.y), u.z);
    }
    float cosine = dot(sampled.direction, at.direction);
    float phase_pdf = mean_phase(path.flags, at, cosine, path_medium(path.flags, at).scattering);
    sampled.pdf = is_even ? phase_pdf : 0.5 * (phase_pdf + world_pdf(sampled.direction));
    sampled.weight = world_radiance(sampled.direction) / max(sampled.pdf, 1e-30);
    return sampled;
}
#endif

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    leave_no_light(index);
    Ray ray = rays[index];
    CameraPath path = camera_paths[index];
    if (!(ray.maximum_distance > 0.0) || !takes_scattered_light(path)
        || bounces_of(path.depth) > iteration.camera_bounces)
        return;
    if (!path_may_scatter(path.flags)) return;
    float far = medium_vertices[index].far;
    MediumSegment segment = MediumSegment(ray, far, path.flags, medium_vertices[index].thickness);
    uvec4 choices =
        pcg4d(uvec4(parameters.first_pixel + index, parameters.segment, iteration.seed, STAGE_IN_SCATTERING << 24u));
    vec4 u = scrambled_sobol4(parameters.light_sample, choices),
         v = scrambled_sobol4(parameters.light_sample, pcg4d(choices));
    float distance = sample_scattered_flight(path.flags, ray, far, segment.thickness, u.xy);
    LightChoice choice = choose_light_at(lit_point(ray.origin + distance * ray.direction),
                                         chosen_environment_irradiance(ray.origin, meets_environment(path)), v.x, v.y);
    if (!(choice.probability > 0.0)) return;
    Light light = lights[choice.light];
    if (bounces_of(path.depth) > light.max_bounces || (light.flags & RAY_VOLUME_SCATTER) == 0u) return;
    bool has_place = light.kind != LIGHT_SUN && light.kind != LIGHT_WORLD;
    Equiangular angles = Equiangular(0.0, 1.0, 0.0, 1.0);
    vec2 range = vec2(0.0, far);
    // Of a ray that passes a spot light's cone by, nothing is lit.
    if (light.kind == LIGHT_SPOT && !within_spot_cone(light, ray.origin, ray.direction, far, range)) return;
    if (has_place) {
        angles = equiangular(segment, light_center(light, choice.triangle), range);
        if (u.w < 0.5) distance = clamp(equiangular_distance(angles, u.z), range.x, range.y);
    }
    vec3 transmittance;
    float pdf = distance_pdf(segment, has_place, angles, distance, transmittance);
    vec3 position = ray.origin + distance * ray.direction;
    LightSample sampled = sample_light(light, choice.triangle, position, v.zw);
    PlaceOnRay at = PlaceOnRay(ray.origin, ray.direction, distance);
#ifndef PORTALS
    if (light.kind == LIGHT_WORLD && !meets_environment(path))
        sampled = sample_world_by_phase(sampled, path, at, vec3(u.w, v.zw));
#endif
    if (!(pdf > 0.0) || !(largest(sampled.weight) > 0.0)) return;
    if (sampled.triangle != NO_EMITTER && emitter_is_hidden_from_media(sampled.triangle)) return;
    vec3 scattered = scattered_phase(path.flags, at, dot(sampled.direction, ray.direction));
    if (light.kind == LIGHT_WORLD) scattered *= world_mis_weight(path, at, scattered, light, sampled.pdf);
    if (parameters.crosses_media == 0u)
        transmittance *= segment_transmittance(path.flags, position, sampled.direction, sampled.distance);
    shadow_media[index] = path.flags & ~PATH_MASK;
    vec3 radiance = path.throughput * transmittance * scattered * sampled.weight / (pdf * choice.probability);
    if (!(largest(radiance) > 0.0)) return;
    uint link = 0u;
    if (iteration.links_lights != 0u)
        link = sampled.triangle != NO_EMITTER ? emitter_link(sampled.triangle) : light.link;
    contributions[index] =
        vec4(parameters.sample_weight * radiance, signed_code(scattered_light_is_gathered(path), link));
    light_triangles[index] = keep_sampled_emitter(sampled.triangle, index);
    if (parameters.splits_light != 0u) light_splits[index] = LightSplit(vec3(0.0), choice.light, vec3(0.0), 0.0);
    float reach = sampled.distance < INFINITY_DISTANCE ? shadow_ray_length(sampled.distance) : INFINITY_DISTANCE;
    shadow_rays[index] = Ray(position, NO_TRIANGLE, sampled.direction, reach);
}
