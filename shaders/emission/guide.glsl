// SPDX-License-Identifier: GPL-3.0-or-later
// What the photons of earlier iterations have taught: the random numbers that place and direct a photon are cut into
// cells, and those from which photons come to importons are chosen more often (after Hachisuka and Jensen 2011).

layout(std430, binding = 3) readonly buffer Guide { uint guide_starts[]; };  // in 2^-32, of each cell's probabilities

uint guide_cells(Light light) { return light.cells.x * light.cells.y * light.cells.z * light.cells.w; }

// Density of choosing a point of a cell, which is 1 without a guide.
float guide_density(Light light, uint cell) {
    uint count = guide_cells(light);
    if (count == 1u) return 1.0;
    uint end = cell + 1u == count ? 0u : guide_starts[light.first_cell + cell + 1u];  // 2^32 wraps to 0
    return float(end - guide_starts[light.first_cell + cell]) * (float(count) / 4294967296.0);
}

// place: where on the light (x of it: which emissive triangle); direction: where to.
uint guide_cell(Light light, vec2 place, vec2 direction) {
    vec4 at = vec4(place, direction) * vec4(light.cells);
    uvec4 cell = min(uvec4(max(at, 0.0)), light.cells - 1u);
    return ((cell.w * light.cells.z + cell.z) * light.cells.y + cell.y) * light.cells.x + cell.x;
}

// Probability, in 2^-32, of the cells from first up to end.
float guide_share(Light light, uint first, uint end) {
    uint count = guide_cells(light);
    if (first == 0u && end == count) return 4294967296.0;
    uint high = end == count ? 0u : guide_starts[light.first_cell + end];  // 2^32 wraps to 0
    return float(high - guide_starts[light.first_cell + first]);
}

// Along one number: u even in [0, 1) to one of the density that `count` groups of `stride` cells have from `cell` on,
// which becomes the first cell of the group that it falls into.
void follow_guide_along(Light light, uint stride, uint count, inout uint cell, inout float u) {
    float at = u * guide_share(light, cell, cell + count * stride);
    uint low = 0u, high = count - 1u;
    while (low < high) {
        uint middle = (low + high + 1u) / 2u;
        if (guide_share(light, cell, cell + middle * stride) <= at) low = middle;
        else high = middle - 1u;
    }
    float before = guide_share(light, cell, cell + low * stride);
    cell += low * stride;
    float inside = (at - before) / guide_share(light, cell, cell + stride);
    u = min((float(low) + clamp(inside, 0.0, 1.0)) / float(count), 0.99999994);
}

// From the unit cubes to where photons are of use, number by number (as Clarberg et al. 2005 warp samples): what the
// guide learns bends the sample set a little, so that frames that learn almost the same send almost the same photons.
// Returns the cell.
uint follow_guide(Light light, inout vec2 place, inout vec2 direction) {
    uvec4 count = light.cells;
    uint cell = 0u;
    follow_guide_along(light, count.x * count.y * count.z, count.w, cell, direction.y);
    follow_guide_along(light, count.x * count.y, count.z, cell, direction.x);
    follow_guide_along(light, count.x, count.y, cell, place.y);
    follow_guide_along(light, 1u, count.x, cell, place.x);
    return cell;
}
