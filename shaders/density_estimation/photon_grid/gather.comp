#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint:
// lint: MEDIA=1
// lint: MEDIA=1 EMISSIVE_MEDIA=1
// Each importon gathers the photons around it and adds them to its sums, which no other thread touches meanwhile.
// A visit is an importon's number and how many photons of its buckets it has looked at before: a thread that comes to
// the end of its rounds leaves the rest to another visit.

layout(local_size_x = 32) in;

#include <GatherPhotonsParameters>
#include "common/iteration.glsl"
#include "common/invocation.glsl"
uniform Parameters { GatherPhotonsParameters parameters; };
#include <Importon>
#include <Photon>
buffer Photons;
readonly buffer Importons;
#include "common/importon.glsl"
#include "density_estimation/photon_grid/grids.glsl"
#include "density_estimation/splat_sums/roulette.glsl"
#include "density_estimation/splat_sums/collect.glsl"
#include "density_estimation/splat_sums/light.glsl"
readonly buffer Buckets;
readonly buffer SortedPhotons;
readonly buffer Visits;
buffer UnfinishedVisits {
    uint unfinished_groups[3];
    uint unfinished_count;
    uvec2 unfinished_visits[];
};

const uint CORNERS = 8u;

// A sphere meets the cell at low and, along those axes whose bits are in steps, the next.
struct Cells {
    ivec3 low;
    uint steps;
};

// A little farther than the radius: rounding must not part a photon from its cell.
float reach_of(float radius) { return 1.0002 * radius + parameters.rounding; }

Cells cells_around(vec3 position, float radius, float side) {
    float reach = reach_of(radius);
    ivec3 low = cell_of(position - reach, side);
    bvec3 steps = greaterThan(cell_of(position + reach, side), low);
    return Cells(low, (steps.x ? 1u : 0u) | (steps.y ? 2u : 0u) | (steps.z ? 4u : 0u));
}

uint finest_grid(float radius) {
    uint grid = CAUSTIC_GRIDS - 1u;
    while (grid > 0u && parameters.caustic_sides[grid] < 2.0 * reach_of(radius)) --grid;
    return grid;
}

void leave(uvec2 visit) {
    uint place = atomicAdd(unfinished_count, 1u);
    unfinished_visits[place] = visit;
    if (place % gl_WorkGroupSize.x == 0u) atomicAdd(unfinished_groups[0], 1u);
}

void main() {
    uint index = invocation_index();
    if (index >= visit_count) return;
    uvec2 visit = visits[index];
    Importon importon = importons[visit.x];
    // Corners of caustic cells, then of those of global photons, then of those of indirect ones.
    uint corner = parameters.caustics != 0u ? 0u : CORNERS;
    uint corners = (importon.gathers & FINAL_GATHER_ORIGIN) == 0u && wide_in_use[1] != 0u ? 3u * CORNERS
                   : wide_in_use[0] != 0u                                                 ? 2u * CORNERS
                                                                                          : CORNERS;
    uint caustic_grid = finest_grid(importon.radius);
    float radius = importon.radius;
    float wide = photon_radius(PHOTON_AFTER_ROUGH_BOUNCE, importon.minimum_radius, radius, iteration.wide_radius);
    Cells cells = cells_around(importon.position, radius, side_of(caustic_grid));
    Cells wide_cells = cells_around(importon.position, wide, parameters.wide_side);
    Collected collected = Collected(uvec2(0u), uvec2(0u), uvec2(0u), 0u, 0u, uvec2(0u));
    uint next = 0u, end = 0u, skip_count = visit.y, tested_count = visit.y, rounds = parameters.max_rounds;
    bool any = false;
    while (true) {
        // On to the next photon within reach first: the threads of a group then evaluate theirs together.
        uint number;
        bool near = false;
        while (!near && rounds > 0u && (next < end || corner < corners)) {
            --rounds;
            if (next < end) {
                uvec4 candidate = sorted_photons[next++];
                ++tested_count;
                vec3 offset = uintBitsToFloat(candidate.xyz) - importon.position;
                near = dot(offset, offset) < radius * radius;
                number = candidate.w;
            } else {
                uint grid = corner < CORNERS ? caustic_grid : CAUSTIC_GRIDS - 1u + corner / CORNERS;
                if (corner >= CORNERS) {
                    radius = wide;
                    cells = wide_cells;
                }
                ivec3 cell = cells.low + ivec3(corner & 1u, (corner >> 1u) & 1u, (corner >> 2u) & 1u);
                if ((corner++ & 7u & ~cells.steps) == 0u) {
                    uvec2 range = buckets[bucket_in(grid, cell)];
                    uint skipped = min(skip_count, range.y - range.x);
                    skip_count -= skipped;
                    next = range.x + skipped;
                    end = range.y;
                }
            }
        }
        if (!near) break;
        if (rejected(photons[number].path, visit.x)) continue;
        Estimate estimate;
        uint stands_for;
        if (!density_estimate(IMPORTON_OF(importon, visit.x), arrived_counts(visit.x), number, estimate, stands_for))
            continue;
        any = true;
        photons[number].depth = photons[number].depth | PHOTON_CONTRIBUTED;
        collect_splat(collected, number, estimate.radiance, corner > CORNERS, stands_for);
        if (parameters.light_sums != 0u) add_light(visit.x, importon, number, photons[number].flags, estimate);
    }
    if (any) write_collected(visit.x, (importon.gathers & FINAL_GATHER_HIT) != 0u, collected);
    if (next < end || corner < corners) leave(uvec2(visit.x, tested_count));
}
