#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint: MEDIA=1
// lint: MEDIA=1 HETEROGENEOUS_MEDIA=1
// Camera paths in dense media: some of them are scattered before they come to the surface at the end of their ray. As
// at a diffuse surface, a final gather leaves from there.

layout(local_size_x = 64) in;

#include <ScatterCameraPathsParameters>
#include "common/iteration.glsl"
#include "common/active_paths.glsl"
#include "common/geometry.glsl"
#include "common/low_discrepancy.glsl"
#include "common/path_depth.glsl"
#include "common/sampling.glsl"
#include "common/bsdf/closure.glsl"
uniform Parameters { ScatterCameraPathsParameters parameters; };
readonly buffer Media;
#include "materials/medium.glsl"
#include "common/phase_functions.glsl"
#include "media/free_flight.glsl"
#include "media/thin_media.glsl"
#include "media/medium_gather.glsl"
readonly buffer Rays;
buffer CameraPaths;
readonly buffer Closures;
readonly buffer Attributes;
readonly buffer Triangles;
buffer MediumVertices;

// Rays that lose less light than this to media are not scattered: what is behind would only become noisy.
const float MOST_PASSING = 0.6;

// Whether the media along the ray of a path may scatter it: it takes photons at points of the ray otherwise.
bool may_scatter(CameraPath path) {
    uint count = medium_count(path.bounce_counts);
    bool takes_media = (path.flags & PATH_FINAL_GATHER) == 0u || is_medium_gather(path);
    return takes_media && count < parameters.most_vertices && count < iteration.volume_bounces
           && bounces_of(path.depth) < iteration.camera_bounces && path_may_scatter(path.flags)
           && !is_thin(path.flags, parameters.least_free_path);
}

// The fraction of the scattering of the media of a path that other media beyond a surface do not have, where they are
// densest.
float scattering_loss(uint flags, uint beyond) {
    float here = dot(most_scattering(flags), vec3(1.0)), there = dot(most_scattering(beyond), vec3(1.0));
    return here > 0.0 ? clamp(1.0 - there / here, 0.0, 1.0) : 0.0;
}

// At the surface at the end of the ray: behind one that transmits no light, there are no photons.
float loss_ahead(uint flags, uint index) {
    Closure closure = closures[index];
    bool transmits = largest(closure.transparent) > 0.0;
    for (int k = 0; k < closure_lobes(closure); ++k)
        transmits = transmits || lobe_transmits(unpack_kind(closures[index].lobes[k].kind));
    if (!transmits) return 1.0;
    return scattering_loss(flags, cross_surface(flags, closure.material, closure_backfacing(closure)));
}

// At the surface that the ray leaves: one that has reflected the path counts as if no light passed it. Where the media
// do not end there, the surface where they did stays the near one.
void leave_near_loss(uint flags, Ray ray, uint index) {
    vec3 v0 = triangle_vertices[3u * ray.source_triangle].xyz;
    vec3 e1 = triangle_vertices[3u * ray.source_triangle + 1u].xyz - v0,
         e2 = triangle_vertices[3u * ray.source_triangle + 2u].xyz - v0;
    vec3 normal = normalize(cross(e1, e2));
    bool was_inside = dot(normal, ray.direction) > 0.0,
         passed = (flags & (PATH_CAMERA_TRANSPARENT | PATH_TRANSMITTED)) != 0u;
    uint before = cross_surface(flags, attributes[ray.source_triangle].material, !was_inside);
    float loss = passed ? scattering_loss(flags, before) : 1.0;
    if (loss > 0.0) {
        medium_vertices[index].near_normal = pack_unit_vector(normal);
        medium_vertices[index].near_loss = loss;
    }
    medium_vertices[index].near_height = loss > 0.0 ? 0.0 : medium_vertices[index].far_height;
}

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    camera_paths[index].medium_passing = 1.0;
    Ray ray = rays[index];
    CameraPath path = camera_paths[index];
    if (!(ray.maximum_distance > 0.0)) return;
    bool has_far = closure_hit(closures[index]);
    float far = has_far ? closures[index].distance : INFINITY_DISTANCE;
    vec3 thickness = segment_thickness(path.flags, ray.origin, ray.direction, far);
    medium_vertices[index].far = far;
    medium_vertices[index].far_normal = closures[index].geometric_normal;
    medium_vertices[index].far_loss = has_far ? loss_ahead(path.flags, index) : 0.0;
    if (ray.source_triangle != NO_TRIANGLE) leave_near_loss(path.flags, ray, index);
    else medium_vertices[index].near_loss = 0.0;
    float near_cosine = abs(dot(unpack_unit_vector(medium_vertices[index].near_normal), ray.direction));
    medium_vertices[index].far_height = medium_vertices[index].near_height + near_cosine * far;
    medium_vertices[index].thickness = thickness;
    float passing = dot(exp(-thickness), vec3(1.0 / 3.0));
    if (!may_scatter(path) || (medium_count(path.bounce_counts) == 0u && passing > MOST_PASSING)) return;
    // A path that does not pass for certain is one that media scatter, even where none is left of it.
    camera_paths[index].medium_passing = min(passing, 0.9999999);
    uvec4 scramble = pcg4d(
        uvec4(parameters.first_pixel + index, parameters.segment, iteration.seed, STAGE_CAMERA_SCATTERING << 24u));
    vec4 u = scrambled_sobol4(iteration.number - 1u, scramble);
    FreeFlight flight = sample_free_flight(path.flags, ray, far, u.xy);
    if (!(flight.pdf > 0.0)) return;
    PlaceOnRay at = PlaceOnRay(ray.origin, ray.direction, flight.distance);
    vec3 scattering = path_medium(path.flags, at).scattering;
    vec3 throughput = path.throughput * flight.transmittance / flight.pdf;
    PhaseFunction phase = sample_path_phase_function(path.flags, at, throughput, u.z);
    throughput *= phase.scattering * (dot(throughput, scattering) / max(dot(throughput, phase.scattering), 1e-30));
    // Russian roulette by what the medium absorbs.
    float survival = min(largest(throughput) / largest(path.throughput), 1.0);
    bool survives = scrambled_sobol(iteration.number - 1u, pcg4d(scramble)).x < survival;
    medium_vertices[index].position = ray.origin + flight.distance * ray.direction;
    float cosine = sample_phase_function(phase, u.z);
    medium_vertices[index].direction = direction_around(ray.direction, cosine, u.w);
    medium_vertices[index].phase_pdf = mean_phase(path.flags, at, cosine, scattering);
    medium_vertices[index].throughput = survives ? throughput / survival : vec3(0.0);
    camera_paths[index].medium_passing = SCATTERED_BY_MEDIUM;
}
