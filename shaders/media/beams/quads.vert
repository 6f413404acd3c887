#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// A quad on the camera's band for every photon beam: all pixels whose rays may pass within its radius.

#include <BeamParameters>
#include "common/constants.glsl"
#include "camera_paths/gbuffer/projections.glsl"
uniform Parameters { BeamParameters parameters; };
#include <PhotonBeam>
readonly buffer PhotonBeams;
readonly buffer Camera;

flat out uint beam_number;

vec3 to_camera(vec3 position) {
    vec3 offset = position - camera.position;
    return vec3(dot(offset, camera.right), dot(offset, camera.up), dot(offset, camera.forward));
}

// The part of the beam before the camera: what lies nearer than this is seen under any angle.
bool clip_beam(inout vec3 first, inout vec3 last, float nearest) {
    if (first.z < nearest && last.z < nearest) return false;
    if (first.z < nearest) first = mix(first, last, (nearest - first.z) / (last.z - first.z));
    if (last.z < nearest) last = mix(last, first, (nearest - last.z) / (first.z - last.z));
    return true;
}

// Pixels of a point of the band.
vec2 to_pixel(vec3 p, bool orthographic) {
    vec2 place = orthographic ? p.xy : p.xy / p.z;
    vec2 low = camera.window.xz, extent = camera.window.yw - camera.window.xz;
    return (place - low) / extent * vec2(camera.width, camera.height);
}

// Pixels that the radius covers around a point: where the view is oblique, a ball is seen as an ellipse.
float pixel_radius(vec3 p, bool orthographic) {
    vec2 scale = vec2(camera.width, camera.height) / (camera.window.yw - camera.window.xz);
    float wide = max(scale.x, scale.y), tangent2 = dot(p.xy, p.xy) / (p.z * p.z);
    float radius = orthographic ? parameters.radius * wide : parameters.radius * wide / p.z * (1.0 + tangent2);
    return max(radius, parameters.radius_pixels * (orthographic ? 1.0 : 1.0 + tangent2)) + 0.05;
}

void main() {
    beam_number = uint(gl_VertexID) / 6u;
    int corner = int[6](0, 1, 2, 2, 1, 3)[gl_VertexID % 6];
    bool orthographic = camera.projection == PROJECTION_ORTHOGRAPHIC;
    float extent = photon_beams[beam_number].extent;
    vec3 first = to_camera(photon_beams[beam_number].origin);
    vec3 last = to_camera(photon_beams[beam_number].origin + extent * photon_beams[beam_number].direction);
    gl_Position = vec4(2.0, 2.0, 0.0, 1.0);
    if (!clip_beam(first, last, orthographic ? 0.0 : max(camera.clip_start, 1.0e-4 * extent))) return;
    vec2 from = to_pixel(first, orthographic), to = to_pixel(last, orthographic), along = to - from;
    float size = length(along), from_radius = pixel_radius(first, orthographic),
          to_radius = pixel_radius(last, orthographic);
    along = size > 1e-3 ? along / size : vec2(1.0, 0.0);
    // The widest end's width on both sides covers the hull of both disks.
    float radius = max(from_radius, to_radius);
    vec2 across = vec2(-along.y, along.x) * ((corner & 1) == 0 ? -radius : radius);
    vec2 place = (corner & 2) == 0 ? from - along * from_radius : to + along * to_radius;
    place += across;
    gl_Position = vec4(2.0 * place / vec2(parameters.width, parameters.height) - 1.0, 0.0, 1.0);
}
