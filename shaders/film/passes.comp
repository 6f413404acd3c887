#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint:
// lint: MEDIA=1
// lint: MEDIA=1 HETEROGENEOUS_MEDIA=1
// lint: HAIR_LOBES=1
// lint: ROUGHNESS_PASS=1
// lint: ASHIKHMIN_LOBES=1
// lint: THIN_FILM_LOBES=1
// lint: RAY_PORTALS=1
// First surfaces of camera paths, for the passes of scene/passes.py. As in Cycles, surfaces below the
// view layer's Alpha Threshold are skipped, and depth is measured along the view axis, or in a panorama along the ray.
// Denoising Data is of the first surface that is not specular. Colors add up over all surfaces by their throughput.

layout(local_size_x = 64) in;

#include <PassParameters>
#include "common/iteration.glsl"
#include "common/active_paths.glsl"
#include "common/bsdf/closure.glsl"
#include "common/camera_path.glsl"
#include "film/first_surface.glsl"
#include "camera_paths/gbuffer/projections.glsl"
readonly buffer Materials;
readonly buffer Media;
#include "materials/medium.glsl"
uniform Parameters { PassParameters parameters; };
#include "film/passes.glsl"
readonly buffer Camera;
#include "camera_paths/gbuffer/sheared.glsl"
readonly buffer Closures;
#include "common/bsdf/stored_lobes.glsl"
#include "film/light_colors.glsl"
readonly buffer Rays;
buffer CameraPaths;
#ifdef HETEROGENEOUS_MEDIA
#include "media/free_flight.glsl"
#endif
// iterations in the means; those with a surface
buffer PassCounts;
readonly buffer Hits;
readonly buffer Attributes;
readonly buffer ShadingInstances;
readonly buffer Radiances;

// Lobes up to this alpha, and what is specular by more than this fraction, denoisers see through. As in Cycles.
const float SPECULAR_ALPHA = 0.075, MOSTLY_SPECULAR = 0.75, MOSTLY_TRANSPARENT = 0.5;
const uint DENOISING_DATA = 1u << PASS_DENOISING_ALBEDO | 1u << PASS_DENOISING_NORMAL | 1u << PASS_DENOISING_DEPTH;
const uint COLORS = 1u << PASS_DIFFUSE_COLOR | 1u << PASS_GLOSSY_COLOR | 1u << PASS_TRANSMISSION_COLOR;

uint index;    // in the band
uvec2 counts;  // with this iteration
bool hit;      // the ray of the path hits a surface

// Value of the first surface, for passes of the kinds MEAN and FIRST. Those of the kind SUM use add_to_pass.
void write_pass(uint which, vec4 value) {
    if (!is_on(which) || (PASS_ACCUMULATION[which] == ACCUMULATION_FIRST && !(hit && counts.y == 1u))) return;
    uint place = place_of(which, index);
    if (!hit) value = vec4(PASS_NOTHING[which]);
    for (uint channel = 0u; channel < PASS_CHANNELS[which]; channel++) {
        float before = pass_values[place + channel];
        pass_values[place + channel] = PASS_ACCUMULATION[which] == ACCUMULATION_MEAN
                                           ? before + (value[channel] - before) / float(counts.x)
                                           : value[channel];
    }
}

void write_pass(uint which, float value) { write_pass(which, vec4(value, 0.0, 0.0, 0.0)); }
void write_pass(uint which, vec2 value) { write_pass(which, vec4(value, 0.0, 0.0)); }
void write_pass(uint which, vec3 value) { write_pass(which, vec4(value, 0.0)); }

float view_depth(vec3 position) {
    vec3 offset = position - camera.position;
    if (camera.projection > PROJECTION_ORTHOGRAPHIC) return length(offset);
    return camera_is_sheared() ? dot(offset, camera_normal()) : dot(offset, camera.forward);
}

// 0 at the start of the mist, 1 at its end.
float mist_at(vec3 position) {
    vec3 offset = position - camera.position;
    float depth = camera.projection == PROJECTION_ORTHOGRAPHIC ? abs(dot(offset, camera.forward)) : length(offset);
    return pow(clamp((depth - parameters.mist_start) * parameters.mist_inverse_depth, 0.0, 1.0),
               parameters.mist_exponent);
}

// Coordinates in the UV map in use, and 1; all 0 on meshes without one.
vec3 uv_at(Hit at) {
    TriangleAttributes corners = attributes[at.triangle];
    vec2 uv = (1.0 - at.b1 - at.b2) * corners.uv0 + at.b1 * corners.uv1 + at.b2 * corners.uv2;
    return vec3(uv, corners.uv0 == corners.uv1 && corners.uv1 == corners.uv2 ? 0.0 : 1.0);
}

// How much of what is behind the media along a ray is seen, where any media of the scene scatter light, and before
// that of what the ray shows.
struct SeenThroughMedia {
    vec3 before;
    vec3 here;
};

SeenThroughMedia seen_through_media(CameraPath path, float distance) {
    SeenThroughMedia seen = SeenThroughMedia(vec3(1.0), vec3(1.0));
#ifdef MEDIA
    if (parameters.media_scatter == 0u) return seen;
    if ((path.flags & PATH_CAMERA_TRANSPARENT) != 0u) seen.before = path.throughput;
    seen.here = segment_transmittance(path.flags, rays[index].origin, rays[index].direction, distance);
#endif
    return seen;
}

float channel_mean(vec3 color) { return (color.r + color.g + color.b) / 3.0; }

#ifdef ROUGHNESS_PASS
// Mean roughness of what reflects and transmits, weighted as in Cycles, whose diffuse parts count where they are rough
// themselves: 1 where nothing counts.
float mean_roughness(Closure closure) {
    vec2 sums = vec2(0.0);  // of roughness times weight, and of weights
    float diffuse = unpackUnorm4x8(closure.diffuse_roughness).w;
    if (diffuse > 0.0) sums += channel_mean(closure.diffuse) * vec2(diffuse, 1.0);
    for (int k = 0; k < closure_lobes(closure); ++k) {
        MicrofacetLobe lobe = stored_lobe(index, k);
        if (lobe.kind != LOBE_NONE && lobe_has_facets(lobe.kind))
            sums += channel_mean(lobe.weight) * vec2(sqrt(lobe.alpha), 1.0);
    }
    return sums.y > 0.0 ? sums.x / sums.y : 1.0;
}
#endif

void write_first_surface(Closure closure, SeenThroughMedia seen) {
    counts = pass_counts[index] + uvec2(1u, hit ? 1u : 0u);
    pass_counts[index] = counts;
    uint triangle = hit ? closure.triangle : 0u;
    write_pass(PASS_DEPTH, view_depth(closure.position));
    float mist = mist_at(closure.position);
#ifdef MEDIA
    // What media scatter counts as mist.
    if (parameters.media_scatter != 0u) mist = 1.0 - channel_mean(seen.before * seen.here) * (1.0 - mist);
#endif
    write_pass(PASS_MIST, mist);
    write_pass(PASS_POSITION, closure.position + parameters.world_origin);
    write_pass(PASS_NORMAL, unpack_unit_vector(closure.shading_normal));
    write_pass(PASS_UV, uv_at(hits[index]));
#ifdef ROUGHNESS_PASS
    write_pass(PASS_ROUGHNESS, mean_roughness(closure));
#endif
    write_pass(PASS_OBJECT_INDEX, float(shading_instances[attributes[triangle].instance].object_index));
    write_pass(PASS_MATERIAL_INDEX, float(materials[closure.material].pass_index));
}

#ifdef MEDIA
// Adds Denoising Data of the media along a ray: as in Cycles, media that scatter light are seen as a surface that faces
// the camera, and has their albedo.
void add_denoising_data_of_media(CameraPath path, float far, SeenThroughMedia seen) {
    if (!path_may_scatter(path.flags)) return;
    PlaceOnRay at = PlaceOnRay(rays[index].origin, rays[index].direction, 0.0);
#ifdef HETEROGENEOUS_MEDIA
    uvec4 random = pcg4d(uvec4(floatBitsToUint(at.direction), iteration.number));
    vec3 thickness = segment_thickness(path.flags, at.origin, at.direction, far);
    vec2 u = vec2(unit_float(random.x), unit_float(random.y));
    at.distance = sample_scattered_flight(path.flags, rays[index], far, thickness, u);
#endif
    MediumCoefficients medium = path_medium(path.flags, at);
    vec3 albedo = medium.scattering / max(medium.absorption + medium.scattering, vec3(1e-30));
    add_to_pass(PASS_DENOISING_ALBEDO, index, path.throughput * albedo * (1.0 - seen.here));
    add_to_pass(PASS_DENOISING_NORMAL, index, vec3(0.0, 0.0, -channel_mean(seen.before * (1.0 - seen.here))));
}
#endif

// Adds Denoising Data of a surface. Returns whether no later surface adds to it.
bool add_denoising_data(CameraPath path, Closure closure, vec3 viewer, SeenThroughMedia seen) {
    vec3 albedo = closure.diffuse + closure.translucent;
    float rough = largest(albedo), total = rough;
    vec3 normal = rough * unpack_unit_vector(closure.diffuse_normal);
    for (int k = 0; k < closure_lobes(closure); ++k) {
        MicrofacetLobe lobe = stored_lobe(index, k);
        if (lobe.kind == LOBE_NONE) continue;
        vec3 lobe_color = lobe_albedo(lobe, lobe_cosine(lobe, viewer));
        float weight = largest(lobe_color);
        total += weight;
        normal += weight * lobe_normal(lobe);
        if (lobe.alpha <= SPECULAR_ALPHA) continue;
        albedo += lobe_color;
        rough += weight;
    }
    if (total <= 0.0 && largest(seen_beyond(closure)) > MOSTLY_TRANSPARENT) return false;
    add_to_pass(PASS_DENOISING_DEPTH, index, vec3(channel_mean(path.throughput * seen.here) * closure.distance));
    if (total > 0.0 && rough <= (1.0 - MOSTLY_SPECULAR) * total) return false;
    add_to_pass(PASS_DENOISING_ALBEDO, index, path.throughput * seen.here * albedo);
    if (total <= 0.0) return true;
    normal /= total;
#ifdef MEDIA
    normal *= channel_mean(seen.before * seen.here);
#endif
    add_to_pass(PASS_DENOISING_NORMAL, index,
                vec3(dot(normal, camera.right), dot(normal, camera.up), dot(normal, camera.forward)));
    return true;
}

#ifdef MEDIA
// Emission of media along a ray that escapes to the world: it is none of the environment, as what path_emission.comp
// adds is then.
vec3 add_media_emission(CameraPath path, bool denoised) {
    vec3 emitted =
        path.throughput * segment_emission(path.flags, rays[index].origin, rays[index].direction, INFINITY_DISTANCE);
    add_to_pass(PASS_EMISSION, index, emitted);
    if (!denoised) add_to_pass(PASS_DENOISING_ALBEDO, index, min(emitted, 1.0));
    return emitted;
}
#endif

void add_colors(CameraPath path, Closure closure, vec3 viewer) {
    LightColors colors = light_colors(index, closure, viewer);
    vec3 throughput =
        path.throughput * segment_transmittance(path.flags, rays[index].origin, -viewer, closure.distance);
    add_to_pass(PASS_DIFFUSE_COLOR, index, throughput * colors.diffuse);
    add_to_pass(PASS_GLOSSY_COLOR, index, throughput * colors.glossy);
    add_to_pass(PASS_TRANSMISSION_COLOR, index, throughput * colors.transmission);
}

void main() {
    index = active_path();
    if (index == NO_PATH) return;
    bool keeps_paths = parameters.keeps_paths != 0u;
    if (!(rays[index].maximum_distance > 0.0)) {
        if (keeps_paths) pass_paths[index].w = 0.0;
        return;
    }
    CameraPath path = camera_paths[index];
    bool camera_transparent = (path.flags & PATH_CAMERA_TRANSPARENT) != 0u,
         needs_surface = needs_first_surface(path.flags);
    bool denoised = (parameters.passes & DENOISING_DATA) == 0u
                    || (path.flags & (PATH_DENOISING_DATA_FOUND | PATH_FINAL_GATHER)) != 0u;
    bool colored = camera_transparent && (parameters.passes & COLORS) != 0u;
    // No pass needs the closure. A pass of later surfaces adds its condition here.
    if (!keeps_paths && !needs_surface && denoised && !colored) return;
    Closure closure = closures[index];
    hit = closure_hit(closure);
    uint kind = (hit ? PASS_PATH_HIT : 0u) | (camera_transparent ? PASS_PATH_CAMERA_TRANSPARENT : 0u)
                | (denoised ? 0u : PASS_PATH_DENOISED);
    vec3 before = radiances[index].rgb;
#ifdef MEDIA
    if (keeps_paths && !hit && camera_transparent) before += add_media_emission(path, denoised);
#endif
    if (keeps_paths) pass_paths[index] = vec4(before, uintBitsToFloat(kind));
    float far = hit ? closure.distance : INFINITY_DISTANCE;
    SeenThroughMedia seen = seen_through_media(path, far);
#ifdef MEDIA
    if (!denoised && parameters.media_scatter != 0u) add_denoising_data_of_media(path, far, seen);
#endif
    if (hit && !denoised && add_denoising_data(path, closure, -rays[index].direction, seen))
        path.flags |= PATH_DENOISING_DATA_FOUND;
    if (hit && colored) add_colors(path, closure, -rays[index].direction);
    if (needs_surface && !is_skipped(closure)) {
        path.flags |= PATH_SURFACE_FOUND;
        write_first_surface(closure, seen);
    }
    camera_paths[index].flags = path.flags;
}
