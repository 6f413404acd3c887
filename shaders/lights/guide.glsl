// SPDX-License-Identifier: GPL-3.0-or-later
// What the photons of earlier iterations have taught: the random numbers that place and direct a photon are cut into
// cells, and those from which photons come to importons are chosen more often (after Hachisuka and Jensen 2011).
#include "common/whole_numbers.glsl"

readonly buffer Guide { uint guide_starts[]; };  // in 2^-32, of each cell's probabilities

uint guide_cells(Light light) { return light.cells.x * light.cells.y * light.cells.z * light.cells.w; }

// Pdf of choosing a point of a cell, which is 1 without a guide.
float guide_pdf(Light light, uint cell) {
    uint count = guide_cells(light);
    if (count == 1u) return 1.0;
    uint end = cell + 1u == count ? 0u : guide_starts[light.first_cell + cell + 1u];  // 2^32 wraps to 0
    return float(end - guide_starts[light.first_cell + cell]) * (float(count) / 4294967296.0);
}

// place: where on the light (x of it: which emissive triangle); direction: where to.
uint guide_cell(Light light, vec2 place, vec2 direction) {
    vec4 at = vec4(place, direction) * vec4(light.cells);
    uvec4 cell = uvec4(whole_part(clamp(at, vec4(0.0), vec4(light.cells - 1u))));
    return ((cell.w * light.cells.z + cell.z) * light.cells.y + cell.y) * light.cells.x + cell.x;
}

uint choose_guide_cell(Light light, uint bits) {
    uint low = 0u, high = guide_cells(light) - 1u;
    while (low < high) {
        uint middle = (low + high + 1u) / 2u;
        if (guide_starts[light.first_cell + middle] <= bits) low = middle;
        else high = middle - 1u;
    }
    return low;
}

// From the unit cubes to a cell's part of them.
void place_in_cell(Light light, uint cell, inout vec2 place, inout vec2 direction) {
    uvec4 at;
    at.x = cell % light.cells.x;
    cell /= light.cells.x;
    at.y = cell % light.cells.y;
    cell /= light.cells.y;
    at.z = cell % light.cells.z;
    at.w = cell / light.cells.z;
    vec4 inside = (vec4(at) + vec4(place, direction)) / vec4(light.cells);
    place = inside.xy;
    direction = inside.zw;
}
