#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint: MEDIA=1
// lint: MEDIA=1 HETEROGENEOUS_MEDIA=1
// lint: MEDIA=1 EMISSIVE_MEDIA=1
// A photon beam meets the camera ray of one pixel (Jarosz et al. 2011, Progressive Photon Beams, eq. 8, with a
// one-dimensional kernel).

#include <BeamParameters>
#include "common/iteration.glsl"
#include "common/geometry.glsl"
#include "common/photon.glsl"
#include "common/path_depth.glsl"
#include "common/volume_bounces.glsl"
uniform Parameters { BeamParameters parameters; };
#include <PhotonBeam>
#include <BeamTarget>
readonly buffer Media;
#include "materials/medium.glsl"
#include "common/phase_functions.glsl"
readonly buffer PhotonBeams;
buffer BeamTargets;
readonly buffer Camera;
buffer Photons;
#include "media/beams/add.glsl"
#include "camera_paths/gbuffer/projections.glsl"

flat in uint beam_number;

const float LEAST_SINE = 1e-4;

bool exceeds_depth(uint camera_depth, PhotonBeam beam) {
    if (!within_volume_bounces(beam.bounce_counts, beam.flags, beam.depth, 1u)) return true;
    uint depth = camera_depth + (beam.depth & DEPTH_MASK), most = iteration.max_bounces;
    if (iteration.limits_bounces != 0u) most = min(most, beam.max_bounces);
    return bounces_of(depth) > most || transparents_of(depth) > iteration.transparent_max_bounces;
}

// The radius at a distance along a camera ray, meters.
float radius_at(float distance) {
    float pixel = sqrt(camera.pixel_area) * (camera.projection == PROJECTION_ORTHOGRAPHIC ? 1.0 : distance);
    return max(parameters.radius, parameters.radius_pixels * pixel);
}

// Factor of a beam's flux at a distance from its origin: the transmittance over the probability of coming there, by
// which the beam is as long as it is. It is 1 in gray media.
vec3 flux_factor(uint flags, float way) {
    vec3 passed = exp(-even_extinction(flags) * way);
    return passed / max(dot(passed, vec3(1.0 / 3.0)), 1e-30);
}

void main() {
    uint pixel = uint(gl_FragCoord.y) * parameters.width + uint(gl_FragCoord.x);
    if (beam_targets[pixel].mark != parameters.segment) return;
    PhotonBeam beam = photon_beams[beam_number];
    BeamTarget target = beam_targets[pixel];
    // Both points where the lines are nearest to each other.
    vec3 between = target.origin - beam.origin;
    float cosine = dot(target.direction, beam.direction), sine2 = max(1.0 - cosine * cosine, LEAST_SINE * LEAST_SINE);
    float along_ray = dot(target.direction, between), along_beam = dot(beam.direction, between);
    float distance = (cosine * along_beam - along_ray) / sine2, way = (along_beam - cosine * along_ray) / sine2;
    if (!(distance > 0.0 && distance < target.far && way > 0.0 && way < beam.extent)) return;
    vec3 offset = between + distance * target.direction - way * beam.direction;
    float radius = radius_at(distance), x2 = dot(offset, offset) / (radius * radius);
    if (!(x2 < 1.0) || exceeds_depth(target.depth, beam)) return;
    float kernel = 0.75 * (1.0 - x2) / radius;
    vec3 radiance = target.throughput * segment_transmittance(target.flags, target.origin, target.direction, distance)
                    * scattered_phase(target.flags, PlaceOnRay(target.origin, target.direction, distance), -cosine)
                    * beam.flux * flux_factor(target.flags, way) * (kernel * inversesqrt(sine2));
    add_beam(pixel, beam, radiance);
}
