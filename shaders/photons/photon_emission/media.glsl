// SPDX-License-Identifier: GPL-3.0-or-later
// Photons that leave media. Their places are even in the box of a medium, where Media tells which lie within its
// surface, or as bright as the voxels of its grid. The includer includes photons/photon_emission/aim.glsl before.

readonly buffer Media;
readonly buffer EmissiveMedia;
readonly buffer EmissionCells;
#include "materials/medium.glsl"

// A place in a medium, and what the medium emits there over the pdf, W.
struct MediumPoint {
    vec3 position;
    vec3 flux;
};

#ifdef HETEROGENEOUS_MEDIA
uint choose_emission_cell(EmissiveMedium source, uint bits) {
    uint low = 0u, high = source.cell_count - 1u;
    while (low < high) {
        uint middle = (low + high + 1u) / 2u;
        if (emission_cells[source.first_cell + middle].y <= bits) low = middle;
        else high = middle - 1u;
    }
    return low;
}

float emission_cell_probability(EmissiveMedium source, uint cell) {
    if (source.cell_count == 1u) return 1.0;
    uint end = cell + 1u == source.cell_count ? 0u : emission_cells[source.first_cell + cell + 1u].y;  // 2^32 wraps
    return float(end - emission_cells[source.first_cell + cell].y) / 4294967296.0;
}

// As far from 0 as linear interpolation weights values, in (-1, 1).
vec3 sample_tent(vec3 u) { return mix(1.0 - sqrt(2.0 - 2.0 * u), sqrt(2.0 * u) - 1.0, lessThan(u, vec3(0.5))); }

// A voxel is chosen by its cell, and a place by what the voxel adds to the linear interpolation there. Beyond the
// outermost voxels, where the medium ends, places are mirrored, and count half.
MediumPoint sample_grid(Light light, EmissiveMedium source, float part, vec2 place, uvec4 bits) {
    uint cell = choose_emission_cell(source, uint(part * 16777216.0) << 8u | bits.x >> 24u);
    uvec3 voxels = media[source.medium].voxels, voxel;
    uint first = emission_cells[source.first_cell + cell].x, side = source.cell_side;
    uint local = bits.y % (side * side * side);
    voxel = uvec3(first % voxels.x, first / voxels.x % voxels.y, first / (voxels.x * voxels.y));
    voxel += uvec3(local % side, local / side % side, local / (side * side));
    MediumPoint none = MediumPoint(light.position, vec3(0.0));
    if (any(greaterThanEqual(voxel, voxels))) return none;
    uint brick = brick_place(media[source.medium].first_word, voxels, voxel / BRICK_SIDE);
    if (brick == 0u) return none;
    vec3 emission = span_coefficients(source.medium, GridSpan(brick, voxel_number(voxel), 0.0, 0.0)).emission;
    vec3 at = vec3(voxel) + 0.5 + sample_tent(vec3(place, unit_float(bits.z)));
    at = max(at, 1.0 - at);
    at = min(at, 2.0 * vec3(voxels) - 1.0 - at);
    bvec3 begins = equal(voxel, uvec3(0u)), ends = equal(voxel + 1u, voxels);
    vec3 halves = mix(vec3(1.0), vec3(0.5), begins) * mix(vec3(1.0), vec3(0.5), ends);
    float weight = halves.x * halves.y * halves.z * float(side * side * side) / emission_cell_probability(source, cell);
    return MediumPoint(light.position + at.x * light.axis_u + at.y * light.axis_v + at.z * light.normal,
                       light.strength * emission * weight);
}
#endif

// The extents of one of several boxes about one center over those of the largest.
vec3 box_extent(EmissiveMedium source, uint box) {
    return source.boxes > 1u ? pow(source.inner, vec3(float(box) / float(source.boxes - 1u))) : vec3(1.0);
}

// Evenly in one of the boxes; the pdf is that of all of them together.
MediumPoint sample_boxes(Light light, EmissiveMedium source, float part, vec2 place) {
    float scaled = part * float(source.boxes);
    uint box = min(uint(scaled), source.boxes - 1u);
    vec3 at = 0.5 + (vec3(scaled - float(box), place) - 0.5) * box_extent(source, box);
    float density = 0.0;
    for (uint k = 0u; k < source.boxes; ++k) {
        vec3 extent = box_extent(source, k);
        if (all(lessThanEqual(abs(2.0 * at - 1.0), extent))) density += 1.0 / (extent.x * extent.y * extent.z);
    }
    return MediumPoint(light.position + at.x * light.axis_u + at.y * light.axis_v + at.z * light.normal,
                       light.strength * (float(source.boxes) / max(density, 1.0)));
}

MediumPoint sample_medium(Light light, float part, vec2 place) {
    EmissiveMedium source = emissive_media[light.emissive_medium];
#ifdef HETEROGENEOUS_MEDIA
    uvec4 bits = pcg4d(uvec4(floatBitsToUint(vec3(part, place)), iteration.number));
    if (source.cell_count > 0u) return sample_grid(light, source, part, place, bits);
#endif
    return sample_boxes(light, source, part, place);
}

Emission emit_from_medium(Light light, EmissionChoice choice) {
    MediumPoint point = sample_medium(light, choice.part, choice.place);
    float cones = target_cones(point.position);
    bool has_targets = cones > 0.0;
    vec3 direction = choice.aimed && has_targets
                         ? sample_target_direction(point.position, cones, choice.target, choice.direction)
                         : sample_sphere(choice.direction);
    float aimed = has_targets ? target_direction_pdf(point.position, cones, direction) : 0.0;
    float pdf = mixed_pdf(light, 1.0 / (4.0 * PI), vec2(choice.part, 0.0), sphere_to_square(direction), aimed,
                          has_targets, choice);
    return Emission(point.position, NO_EMITTER, direction, point.flux / (4.0 * PI * pdf), pdf, INFINITY_DISTANCE);
}
