#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Importons enter the lists of the cubemap pixels that they project to; those around the center,
// where a photon's footprint has no bound, enter the core list.

layout(local_size_x = 64) in;

#include <CubeParameters>
#include "common/iteration.glsl"
#include "common/active_paths.glsl"
#include "density_estimation/splatting/cube.glsl"
uniform Parameters { CubeParameters parameters; };
buffer Importons;
buffer Heads;
buffer Core;

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    if (!(importons[index].radius > 0.0)) return;
    vec3 p = importons[index].position - parameters.center;
    float core_radius = 2.0 * max(parameters.radius, iteration.wide_radius);
    if (dot(p, p) < core_radius * core_radius) {
        core_importons[atomicAdd(core_count, 1u)] = index;
        return;
    }
    int face = face_of(p);
    vec3 q = to_face(p, face);
    int size = int(parameters.resolution);
    ivec2 cell = ivec2(clamp(floor((q.xy / q.z * 0.5 + 0.5) * float(size)), vec2(0.0), vec2(float(size - 1))));
    int bounds = face_bounds(face, size);
    uvec4 reach = uvec4(size - cell, cell + 1);
    for (int k = 0; k < 4; ++k)
        if (heads[bounds + k] < reach[k]) atomicMax(heads[bounds + k], reach[k]);
    heads[block_index(face, cell / BLOCK_SIZE, size)] = 1u;
    importons[index].next = atomicExchange(heads[(face * size + cell.y) * size + cell.x], index + 1u);
}
