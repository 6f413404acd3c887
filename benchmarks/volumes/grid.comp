// SPDX-License-Identifier: GPL-3.0-or-later
// Puts photons into lists, one a cell.
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Photons { Photon photons[]; };
layout(std430, binding = 2) buffer Heads { int heads[]; };
layout(std430, binding = 3) buffer Nexts { int nexts[]; };
uniform uint count;
uniform float cell_size;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= count) return;
    ivec3 cell = clamp(ivec3((photons[index].position_power.xyz + 1.5) / cell_size), ivec3(0), ivec3(CELLS - 1));
    nexts[index] = atomicExchange(heads[cell.x + CELLS * (cell.y + CELLS * cell.z)], int(index));
}
