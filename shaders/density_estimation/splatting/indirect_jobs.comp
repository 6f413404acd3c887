#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// IndirectSplatting: which cubemap pixels each stored photon may reach (Fig. 6c).
//
// Importons within two radii of the center are in the core list, so a photon within one radius
// needs no quad, and the directions to the importons that a farther one can reach part from its own
// by 30 degrees at most.

layout(local_size_x = 64) in;

#include <CubeParameters>
#include "common/iteration.glsl"
#include "common/invocation.glsl"
#include "common/photon.glsl"
#include "density_estimation/splatting/cube.glsl"
#include "density_estimation/splatting/sphere_bounds.glsl"
#include "density_estimation/splatting/jobs.glsl"
uniform Parameters { CubeParameters parameters; };
readonly buffer Photons;
readonly buffer StoredPhotons;
readonly buffer Heads;
buffer Jobs;

// Most photons have no importon near them: a footprint shrinks to the cells, or the blocks of cells,
// that hold some. False: it holds none.
const int SMALL_AREA = 64;

bool shrink_to_occupied(int face, int size, inout ivec2 first, inout ivec2 last) {
    ivec2 extent = last - first;
    bool by_cell = extent.x * extent.y <= SMALL_AREA;
    int step = by_cell ? 1 : BLOCK_SIZE;
    ivec2 low = first / step, high = (last - 1) / step;
    ivec2 occupied_low = ivec2(size), occupied_high = ivec2(-1);
    for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) {
            int place = by_cell ? (face * size + y) * size + x : block_index(face, ivec2(x, y), size);
            if (heads[place] == 0u) continue;
            occupied_low = min(occupied_low, ivec2(x, y));
            occupied_high = max(occupied_high, ivec2(x, y));
        }
    first = max(first, occupied_low * step);
    last = min(last, (occupied_high + 1) * step);
    return occupied_high.x >= 0;
}

// Behind the last bounces of most scenes no importon is left.
bool any_importon(int size) {
    uint cells = 0u;
    for (int face = 0; face < 6; ++face) cells |= heads[face_bounds(face, size)];
    return cells != 0u;
}

void main() {
    uint index = invocation_index();
    if (index >= parameters.count || !any_importon(int(parameters.resolution))) return;
    uint number = stored_photons[index];
    if (parameters.gathers != 0u && (photons[number].flags & PHOTON_INDIRECT) != 0u) return;
    vec3 p = photons[number].position - parameters.center;
    float distance = length(p), radius = photon_radius(photons[number].flags, parameters.minimum_radius,
                                                       parameters.radius, iteration.wide_radius);
    if (distance < radius * 0.9999) return;
    float cosine = min((distance * distance + 3.0 * radius * radius) / (4.0 * distance * radius), 1.0);
    float sine =
        distance >= 2.236 * radius ? radius / distance * 1.00001 : sqrt(max(1.0 - cosine * cosine, 0.0)) + 1e-3;
    p /= distance;
    int size = int(parameters.resolution);
    for (int face = 0; face < 6; ++face) {
        int bounds = face_bounds(face, size);
        if (heads[bounds] == 0u) continue;
        vec3 q = to_face(p, face);
        vec2 across, along;
        if (q.z < -sine || !sphere_tangents(q.xz, sine, vec2(-1.0, 1.0), across)
            || !sphere_tangents(q.yz, sine, vec2(-1.0, 1.0), along))
            continue;
        vec2 low = floor((vec2(across.x, along.x) * 0.5 + 0.5) * float(size) - 1e-2);
        vec2 high = floor((vec2(across.y, along.y) * 0.5 + 0.5) * float(size) + 1e-2) + 1.0;
        vec2 bounds_low = vec2(float(size)) - vec2(heads[bounds], heads[bounds + 1]);
        ivec2 first = ivec2(max(low, bounds_low)), last = ivec2(min(high, vec2(heads[bounds + 2], heads[bounds + 3])));
        if (any(greaterThanEqual(first, last)) || !shrink_to_occupied(face, size, first, last)) continue;
        ivec2 corner = ivec2(face % 3, face / 3) * size;
        uvec2 from = uvec2(corner + first), to = uvec2(corner + last);
        uint job = atomicAdd(job_vertices, 6u) / 6u;
        jobs[job] = SplatJob(number, from.x | (from.y << 16u), to.x | (to.y << 16u), uint(face));
    }
}
