// SPDX-License-Identifier: GPL-3.0-or-later
// The grids that photons are sorted into. Caustic photons (PHOTON_AFTER_ROUGH_BOUNCE not set) lie in each of
// CAUSTIC_GRIDS, whose cells are ever smaller, since importons differ in their narrow radius; the others in one of two,
// since importons whose paths go on by a gathering ray take no indirect ones. Sides and numbers of buckets:
// photon_grid.py. Needs the members caustic_sides, wide_side, caustic_buckets and wide_buckets of the parameters.
#include "density_estimation/photon_grid/cells.glsl"

#include <PhotonGrids>
const uint GRID_GLOBAL = CAUSTIC_GRIDS, GRID_INDIRECT = CAUSTIC_GRIDS + 1u;

float side_of(uint grid) { return grid < CAUSTIC_GRIDS ? parameters.caustic_sides[grid] : parameters.wide_side; }

uint bucket_in(uint grid, ivec3 cell) {
    if (grid < CAUSTIC_GRIDS) return grid * parameters.caustic_buckets + bucket_of(cell, parameters.caustic_buckets);
    return CAUSTIC_GRIDS * parameters.caustic_buckets + (grid - CAUSTIC_GRIDS) * parameters.wide_buckets
           + bucket_of(cell, parameters.wide_buckets);
}

// The first and the last grid that a photon lies in.
uvec2 grids_of(uint photon_flags) {
    if ((photon_flags & PHOTON_AFTER_ROUGH_BOUNCE) == 0u) return uvec2(0u, CAUSTIC_GRIDS - 1u);
    return uvec2((photon_flags & PHOTON_INDIRECT) != 0u ? GRID_INDIRECT : GRID_GLOBAL);
}
