#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// What the camera sees first, for the passes of scene/passes.py. As in Cycles, surfaces that let more than half of the
// light straight through are passed, and depth lies along the view axis, or in a panorama along the ray.

layout(local_size_x = 64) in;

#include <PassParameters>
#include <Passes>
#include "common/living_paths.glsl"
#include "common/geometry.glsl"
#include "common/camera_path.glsl"
#include "gbuffer/projections.glsl"
layout(std140, binding = 0) uniform Parameters { PassParameters parameters; };
layout(std430, binding = 0) readonly buffer Camera;
layout(std430, binding = 1) readonly buffer Closures;
layout(std430, binding = 2) readonly buffer Rays;
layout(std430, binding = 3) buffer CameraPaths;
layout(std430, binding = 4) buffer PassValues { float pass_values[]; };
// iterations in the means; those with a surface
layout(std430, binding = 5) buffer PassCounts { uvec2 pass_counts[]; };
layout(std430, binding = 6) readonly buffer Hits;
layout(std430, binding = 7) readonly buffer Attributes;

const float MOSTLY_TRANSPARENT = 0.5;

uint pixel;
uvec2 counts;      // with this iteration
bool hit;          // else the path passed all by
uint index;

bool is_on(uint which) { return (parameters.passes & (1u << which)) != 0u; }

// Where the pixel's values of a pass begin: those of a pass lie together.
uint place_of(uint which) {
    uint before = 0u;
    for (uint other = 0u; other < which; other++) before += is_on(other) ? PASS_CHANNELS[other] : 0u;
    return before * parameters.pixels + PASS_CHANNELS[which] * pixel;
}

void write_pass(uint which, vec4 value) {
    if (!is_on(which) || (PASS_ACCUMULATION[which] == ACCUMULATION_FIRST && !(hit && counts.y == 1u))) return;
    uint place = place_of(which);
    if (!hit) value = vec4(0.0);
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

void clear() {
    pass_counts[pixel] = uvec2(0u);
    for (uint which = 0u; which < PASS_COUNT; which++)
        for (uint channel = 0u; is_on(which) && channel < PASS_CHANNELS[which]; channel++)
            pass_values[place_of(which) + channel] = PASS_NOTHING[which];
}

float view_depth(vec3 position) {
    vec3 offset = position - camera.position;
    return camera.projection <= PROJECTION_ORTHOGRAPHIC ? dot(offset, camera.forward) : length(offset);
}

// Of the UV map in use, and 1; all 0 on meshes without one.
vec3 uv_at(Hit at) {
    TriangleAttributes corners = attributes[at.triangle];
    vec2 uv = (1.0 - at.b1 - at.b2) * corners.uv0 + at.b1 * corners.uv1 + at.b2 * corners.uv2;
    return vec3(uv, corners.uv0 == corners.uv1 && corners.uv1 == corners.uv2 ? 0.0 : 1.0);
}

void main() {
    index = living_path();
    if (index == NO_PATH) return;
    pixel = parameters.first_pixel + index;
    if (parameters.segment == 0u && parameters.iteration == 1u) clear();
    uint flags = camera_paths[index].flags;
    if (!(rays[index].maximum_distance > 0.0) || (flags & PATH_STRAIGHT) == 0u || (flags & PATH_SURFACE_FOUND) != 0u)
        return;
    hit = closures[index].triangle != NO_TRIANGLE;
    vec3 transparent = closures[index].transparent;
    if (hit && (transparent.r + transparent.g + transparent.b) / 3.0 > MOSTLY_TRANSPARENT) return;
    camera_paths[index].flags = flags | PATH_SURFACE_FOUND;
    counts = pass_counts[pixel] + uvec2(1u, hit ? 1u : 0u);
    pass_counts[pixel] = counts;

    write_pass(PASS_DEPTH, view_depth(closures[index].position));
    write_pass(PASS_NORMAL, unpack_unit_vector(closures[index].shading_normal));
    write_pass(PASS_POSITION, closures[index].position);
    write_pass(PASS_UV, uv_at(hits[index]));
}
