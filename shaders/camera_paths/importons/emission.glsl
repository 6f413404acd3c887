// SPDX-License-Identifier: GPL-3.0-or-later
// Emission along the ray of a camera path: of media, light objects, surfaces and the environment. The includer
// includes camera_paths/importons/path_vertex.glsl before.

#include "common/clamping.glsl"

// Radiance that arrives at the origin of a final gather counts by the throughput there.
void add_radiance(PathSegment segment, vec4 radiance) {
    bool has_origin = is_final_gather(segment.path) && !is_medium_gather(segment.path);
    vec3 weight = has_origin ? final_gather_origins[segment.index].weight : vec3(1.0);
    uint bounces = bounces_before_emission(bounces_of(segment.path.depth));
    radiances[segment.index] += vec4(clamped_light(weight * radiance.rgb, bounces), radiance.a);
}

// Media along the ray weaken what is behind them, and emit light themselves. Neighboring pixels reuse that light where
// the ray is of a final gather.
void handle_media(inout PathSegment segment) {
    vec3 emitted = segment.path.throughput
                   * segment_emission(segment.path.flags, segment.ray.origin, segment.ray.direction, segment.distance);
    if (is_medium_gather(segment.path)) emitted = vec3(0.0);
    if (is_final_gather(segment.path)) final_gather_hits[segment.index].radiance += emitted;
    else radiances[segment.index].rgb += emitted;
    segment.path.throughput *=
        segment_transmittance(segment.path.flags, segment.ray.origin, segment.ray.direction, segment.distance);
}

// Radiance of the light objects that the ray intersects, at its origin.
vec3 light_object_emission(PathSegment segment) {
    CameraPath path = segment.path;
    if (!path_collects_emission(path) || (path.flags & PATH_LIGHTS_FOUND) != 0u) return vec3(0.0);
    return visible_light(segment.from, segment.ray, segment.distance, camera_ray_kind(path.flags), path.flags);
}

// MIS weight of a ray that meets an emissive triangle, which shadow rays from its origin sample as well.
float emission_mis_weight(ScatterPoint from, uint triangle) {
    if (!(from.pdf > 0.0)) return 1.0;
    float pdf = emissive_triangle_pdf(from.lit.position, triangle);
    EmitterNumber leaf = emitter_leaf(triangle);
    if (pdf > 0.0 && emitter_number(leaf) > 0u)
        pdf *= light_probability(from.lit, from.environment_irradiance, KIND_TRIANGLES, leaf);
    else pdf = 0.0;
    return scatter_mis_weight(from.pdf, pdf);
}

// Radiance of a surface, weighted by the path's throughput, and what a holdout takes of the alpha. Shadow rays alone
// bring the emission that the path's flags say was sampled, and to a final gather that of linked lights.
vec4 surface_emission(CameraPath path, ScatterPoint from, Closure closure) {
    vec4 radiance = vec4(0.0);
    uint traits = emitter_traits(closure.triangle);
    bool is_sampled = (path.flags & PATH_LIGHTS_FOUND) != 0u && (traits & EMITTER_REFLECTED) != 0u;
    bool is_for_shadow_rays = from.gathers && (iteration.gathers_lights == 0u || traits >> EMITTER_LINK_SHIFT != 0u);
    if (largest(closure.emission) > 0.0 && path_collects_emission(path) && !is_sampled && !is_for_shadow_rays)
        radiance.rgb = path.throughput * closure.emission * emission_mis_weight(from, closure.triangle);
    if (sees_background(path.flags))
        radiance.a = -(closure_holdout(closure) * (path.throughput.r + path.throughput.g + path.throughput.b) / 3.0);
    return radiance;
}

// lights: radiance of the light objects that the ray intersects.
void handle_emission(PathSegment segment, SurfaceVertex vertex, vec3 lights) {
    vec4 light_objects = vec4(segment.origin_throughput * lights, 0.0);
    add_radiance(segment, light_objects + surface_emission(vertex.path, segment.from, vertex.closure));
}
