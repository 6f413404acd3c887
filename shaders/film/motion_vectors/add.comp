#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// How far, in pixels, what a pixel shows has come since the frame before, and how far it is from where it will be in
// the next frame: the pass Vector as Cycles has it.

layout(local_size_x = 64) in;

#include <MotionVectorParameters>
#include <NeighborPlaces>
#include "common/iteration.glsl"
#include "common/active_paths.glsl"
#include "common/bsdf/closure.glsl"
#include "common/camera_path.glsl"
#include "common/finite.glsl"
#include "common/placed_point.glsl"
#include "film/first_surface.glsl"
uniform Parameters { MotionVectorParameters parameters; };
readonly buffer Closures;
readonly buffer Rays;
readonly buffer CameraPaths;
readonly buffer Hits;
readonly buffer Triangles;
readonly buffer Attributes;
readonly buffer CornerVertices;
readonly buffer TriangleCorners;
readonly buffer NeighborPlaces;
readonly buffer NeighborInstances;
readonly buffer NeighborPositions;
readonly buffer PassCounts;
buffer MotionVectors { vec4 motion_vectors[]; };
readonly buffer Camera;
#include "camera_paths/gbuffer/panorama_place.glsl"

vec3 between(vec3 v0, vec3 v1, vec3 v2, Hit hit) { return (1.0 - hit.b1 - hit.b2) * v0 + hit.b1 * v1 + hit.b2 * v2; }

// Pixels from the lower left corner of the frame, as a camera sees a point.
vec2 raster_at(vec3 point, mat4 world_to_camera, vec4 window) {
    vec3 at = (world_to_camera * vec4(point, 1.0)).xyz;
    vec2 place;
    if (camera.projection == PROJECTION_ORTHOGRAPHIC) place = at.xy;
    else if (camera.projection == PROJECTION_PERSPECTIVE) place = at.xy / -at.z;
    else place = panorama_place(normalize(vec3(at.xy, -at.z)));
    return (place - window.xz) / (window.yw - window.xz) * parameters.resolution;
}

// The shorter way, where a panorama shows all around.
vec2 way(vec2 from, vec2 to) {
    vec2 pixels = to - from;
    float period = panorama_period() * parameters.resolution.x;
    if (period != 0.0) pixels.x -= period * round(pixels.x / period);
    return pixels;
}

// Where a triangle of its mesh is hit in a neighboring frame, all else being equal.
vec3 neighbor_point(NeighborInstance instance, uint triangle, Hit hit) {
    mat3 linear = transpose(mat3(instance.row0.xyz, instance.row1.xyz, instance.row2.xyz));
    vec3 origin = vec3(instance.row0.w, instance.row1.w, instance.row2.w);
    uint first_corner = 3u * (instance.mesh_triangle + triangle);
    vec3 points[3];
    for (uint k = 0u; k < 3u; ++k) {
        uint turned = instance.mirrored != 0u && k > 0u ? 3u - k : k;
        uint corner = instance.mesh_corner + triangle_corners[first_corner + turned];
        uint at = 3u * (instance.mesh_vertex + corner_vertices[corner]);
        vec3 local = vec3(neighbor_positions[at], neighbor_positions[at + 1u], neighbor_positions[at + 2u]);
        points[k] = placed_point(linear, origin, local - instance.pivot);
    }
    return between(points[0], points[1], points[2], hit);
}

vec4 vector_at(Hit hit) {
    uint first = 3u * hit.triangle;
    vec3 here = between(triangle_vertices[first].xyz, triangle_vertices[first + 1u].xyz,
                        triangle_vertices[first + 2u].xyz, hit);
    vec3 before = here, after = here;
    uint neighbor = neighbor_places[attributes[hit.triangle].instance];
    if (neighbor != RESTS) {
        uint triangle = attributes[hit.triangle].mesh_triangle;
        before = neighbor_point(neighbor_instances[neighbor], triangle, hit);
        after = neighbor_point(neighbor_instances[neighbor + 1u], triangle, hit);
    }
    vec2 center = raster_at(here, parameters.world_to_camera, parameters.window);
    vec2 place_before = raster_at(before, parameters.world_to_camera_before, parameters.window_before);
    vec2 place_after = raster_at(after, parameters.world_to_camera_after, parameters.window_after);
    vec4 vector = vec4(way(center, place_before), way(place_after, center));
    // What comes from the plane of the camera itself.
    return is_finite(vector.xyz) && is_finite(vector.www) ? vector : vec4(0.0);
}

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    bool first = iteration.number_in_film == 1u && parameters.segment == 0u;
    if (first) motion_vectors[index] = vec4(0.0);
    if (!(rays[index].maximum_distance > 0.0) || !needs_first_surface(camera_paths[index].flags)) return;
    Closure closure = closures[index];
    if (!closure_hit(closure) || is_skipped(closure)) return;
    // Those found before: passes.comp counts this one.
    uint surface_count = first ? 0u : pass_counts[index].y;
    vec4 mean = motion_vectors[index];
    motion_vectors[index] = mean + (vector_at(hits[index]) - mean) / float(surface_count + 1u);
}
