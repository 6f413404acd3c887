#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// The emission of a node graph that belongs to no surface: of a world or a volume over the directions of an
// equirectangular map, of a light over a map that suits it.

layout(local_size_x = 64) in;

#include <EvaluateParameters>
#include "common/invocation.glsl"
uniform Parameters { EvaluateParameters parameters; };
#include "materials/data.glsl"
#include "materials/surface.glsl"
#include "materials/builder.glsl"
#include "materials/light_surface.glsl"
writeonly buffer Emissions;

#include "materials/generated.glsl"

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    uint row = parameters.first_row + index / parameters.width, column = index % parameters.width;
    vec2 uv = (vec2(column, row) + 0.5) / vec2(parameters.width, parameters.height);
    float azimuth = (0.5 - uv.x) * 2.0 * PI, polar = (1.0 - uv.y) * PI;
    vec3 direction = vec3(sin(polar) * cos(azimuth), sin(polar) * sin(azimuth), cos(polar));
    Surface surface = Surface(direction, -direction, -direction, -direction, vec2(0.0), vec3(0.0), vec3(0.0),
                              NO_TRIANGLE, NO_INSTANCE, false, parameters.from_camera != 0u ? RAY_CAMERA : RAY_DIFFUSE,
                              parameters.ray_length, 0u, 0u, 0u, 0u);
    if (parameters.light_shape != 0u) surface = light_surface(uv, direction);
    ClosureBuilder builder = closure_builder(surface.viewer, surface.geometric, surface.normal, false, 0.0);
    evaluate_material(surface, parameters.first_constant, builder);
    emissions[index] = vec4(builder.closure.emission, 0.0);
}
