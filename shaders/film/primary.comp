#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// What the camera sees first: normals averaged over the iterations, depth of the first one.

layout(local_size_x = 64) in;

#include <CameraView>
#include <Closure>
#include <FilmParameters>
#include "common/invocation.glsl"
#include "common/geometry.glsl"
layout(std140, binding = 0) uniform Parameters { FilmParameters parameters; };
layout(std430, binding = 0) readonly buffer Camera { CameraView camera; };
layout(std430, binding = 1) readonly buffer Closures { Closure closures[]; };
layout(std430, binding = 2) buffer Surfaces { vec4 surfaces[]; };

const float BACKGROUND_DEPTH = 1e10;  // as Cycles writes it

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    Closure closure = closures[index];
    bool hit = closure.triangle != NO_TRIANGLE;
    vec3 normal = hit ? unpack_unit_vector(closure.shading_normal) : vec3(0.0);
    uint pixel = parameters.first_pixel + index;
    vec4 surface = surfaces[pixel];
    if (parameters.iteration == 1u)
        surface = vec4(vec3(0.0), hit ? dot(closure.position - camera.position, camera.forward) : BACKGROUND_DEPTH);
    surface.xyz += (normal - surface.xyz) / float(parameters.iteration);
    surfaces[pixel] = surface;
}
