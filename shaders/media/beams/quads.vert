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

// Cuts off the part of the beam that lies farther than its radius outside of a plane through the camera. Returns
// whether anything is left.
bool clip_side(inout vec3 first, inout vec3 last, vec3 inward) {
    inward = normalize(inward);
    float a = dot(inward, first) + 1.01 * parameters.radius, b = dot(inward, last) + 1.01 * parameters.radius;
    if (a < 0.0 && b < 0.0) return false;
    if (a < 0.0) first = mix(first, last, a / (a - b));
    else if (b < 0.0) last = mix(last, first, b / (b - a));
    return true;
}

// The part of the beam that rays of the band may meet: beyond it, the projection stretches radii without bound.
bool clip_to_view(inout vec3 first, inout vec3 last) {
    vec2 low = camera.window.xz, high = camera.window.yw, far = max(abs(low), abs(high));
    vec2 pixel = (high - low) / vec2(camera.width, camera.height);
    vec2 margin = (parameters.radius_pixels + 1.0) * (1.0 + dot(far, far)) * pixel;
    low -= margin;
    high += margin;
    return clip_side(first, last, vec3(1.0, 0.0, -low.x)) && clip_side(first, last, vec3(-1.0, 0.0, high.x))
           && clip_side(first, last, vec3(0.0, 1.0, -low.y)) && clip_side(first, last, vec3(0.0, -1.0, high.y));
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

// A corner of the quad around the hull of the disks at both ends of what is seen of a beam. The sides touch both disks.
vec2 hull_corner(vec3 first, vec3 last, uint corner, bool orthographic) {
    vec2 from = to_pixel(first, orthographic), to = to_pixel(last, orthographic), along = to - from;
    float size = length(along), from_radius = pixel_radius(first, orthographic),
          to_radius = pixel_radius(last, orthographic);
    along = size > 1e-3 ? along / size : vec2(1.0, 0.0);
    float sine = (to_radius - from_radius) / max(size, 1e-3);
    vec2 widths = vec2(max(from_radius, to_radius));
    if (abs(sine) < 0.99) widths = vec2(from_radius * (1.0 - sine), to_radius * (1.0 + sine)) / sqrt(1.0 - sine * sine);
    bool is_first = (corner & 2u) == 0u;
    vec2 across = vec2(-along.y, along.x) * ((corner & 1u) == 0u ? -1.0 : 1.0) * (is_first ? widths.x : widths.y);
    return across + (is_first ? from - along * from_radius : to + along * to_radius);
}

void main() {
    beam_number = uint(gl_VertexID) / 6u;
    uint corner = uint[6](0u, 1u, 2u, 2u, 1u, 3u)[gl_VertexID % 6];
    bool orthographic = camera.projection == PROJECTION_ORTHOGRAPHIC;
    PhotonBeam beam = photon_beams[beam_number];
    vec3 first = to_camera(beam.origin), last = to_camera(beam.origin + beam.extent * beam.direction);
    gl_Position = vec4(2.0, 2.0, 0.0, 1.0);
    if (orthographic ? !clip_side(first, last, vec3(0.0, 0.0, 1.0)) : !clip_to_view(first, last)) return;
    vec2 size = vec2(parameters.width, parameters.height);
    // What passes by the camera is seen under any angle.
    bool is_near = !orthographic && min(first.z, last.z) < 2.0 * parameters.radius;
    vec2 place = is_near ? size * vec2(corner & 1u, corner >> 1u) : hull_corner(first, last, corner, orthographic);
    gl_Position = vec4(2.0 * place / size - 1.0, 0.0, 1.0);
}
