// SPDX-License-Identifier: GPL-3.0-or-later
// Grids of media whose coefficients vary: rays through their voxels, in which the coefficients are constant. A ray
// looks the coefficients up with a random offset of up to half a voxel, so that the expected density is that of
// trilinear interpolation. The includer declares before the block Media. Words of MediumVoxels: for each medium a table
// of bricks of 8^3 voxels, with the place of each brick's voxels or 0 for a brick without effect, then the voxels, two
// half floats a word, channel by channel (rppm_addon/materials/media/bricks.py).

#include "common/half.glsl"
#include "common/iteration.glsl"
#include "common/random.glsl"
#include <VoxelBricks>

#ifdef HETEROGENEOUS_MEDIA
layout(r32ui) restrict readonly uniform uimageBuffer MediumVoxels;

bool has_grid(uint medium) { return media[medium].voxels.x > 0u; }

// The offset of a ray in voxels, (-0.5, 0.5)^3. The same ray has the same one in all programs of an iteration.
vec3 lookup_offset(vec3 origin, vec3 direction) {
    uvec4 key = uvec4(floatBitsToUint(origin), iteration.number) + 0x9e3779b9u * uvec4(floatBitsToUint(direction), 1u);
    uvec4 bits = pcg4d(key);
    return vec3(unit_float(bits.x), unit_float(bits.y), unit_float(bits.z)) - 0.5;
}

// A ray in a medium's grid.
struct GridRay {
    uint medium;
    vec3 origin;     // where it enters the grid, voxels
    vec3 direction;  // voxels a meter
    vec3 inverse;    // of the direction, meters a voxel
    ivec3 voxels;    // of the grid
    uint words;      // place of the grid's first word
    float start;     // distance along the ray to where it enters the grid, meters
    float at;        // how far it has come since, meters
    float end;       // and how far it goes, meters
    ivec3 cell;      // the voxel that it comes to
};

// A part of a ray on which the coefficients are constant.
struct GridSpan {
    uint brick;    // place of the brick's voxels; 0: without effect
    uint voxel;    // number of the voxel in the brick
    float extent;  // meters
    float before;  // distance along the ray from where it enters the grid, meters
};

GridRay grid_ray(uint medium, vec3 origin, vec3 direction, float distance, vec3 offset) {
    vec4 point = vec4(origin, 1.0);
    Medium grid = media[medium];
    vec3 o = vec3(dot(grid.to_grid0, point), dot(grid.to_grid1, point), dot(grid.to_grid2, point));
    vec3 d =
        vec3(dot(grid.to_grid0.xyz, direction), dot(grid.to_grid1.xyz, direction), dot(grid.to_grid2.xyz, direction));
    d = mix(d, vec3(1e-20), lessThan(abs(d), vec3(1e-20)));
    // The medium ends at the centers of the outermost voxels.
    vec3 inverse = 1.0 / d, low = (vec3(0.5) - o) * inverse, high = (vec3(grid.voxels) - 0.5 - o) * inverse;
    vec3 near = min(low, high), far = max(low, high);
    float start = max(max(near.x, max(near.y, near.z)), 0.0);
    float end = min(min(far.x, min(far.y, far.z)), distance);
    vec3 entry = o + start * d + offset;
    ivec3 cell = clamp(ivec3(floor(entry)), ivec3(0), ivec3(grid.voxels) - 1);
    return GridRay(medium, entry, d, inverse, ivec3(grid.voxels), grid.first_word, start, 0.0, end - start, cell);
}

// The place of a brick's voxels, of a grid of so many voxels whose words begin at a place.
uint brick_place(uint words, uvec3 voxels, uvec3 brick) {
    uvec3 bricks = (voxels + (BRICK_SIDE - 1u)) / BRICK_SIDE;
    uint number = brick.x + bricks.x * (brick.y + bricks.y * brick.z);
    return imageLoad(MediumVoxels, int(words + number)).x;
}

// The place of the brick's voxels that a ray comes to.
uint brick_place(GridRay ray) { return brick_place(ray.words, uvec3(ray.voxels), uvec3(ray.cell) / BRICK_SIDE); }

uint voxel_number(uvec3 cell) {
    uvec3 local = cell % BRICK_SIDE;
    return local.x + BRICK_SIDE * (local.y + BRICK_SIDE * local.z);
}

// The next part of a ray; false at its end.
bool next_span(inout GridRay ray, out GridSpan span) {
    span = GridSpan(0u, 0u, 0.0, ray.at);
    if (!(ray.at < ray.end)) return false;
    span.brick = brick_place(ray);
    span.voxel = voxel_number(uvec3(ray.cell));
    vec3 low = vec3(span.brick == 0u ? ray.cell & ~int(BRICK_SIDE - 1u) : ray.cell);
    vec3 high = low + (span.brick == 0u ? float(BRICK_SIDE) : 1.0);
    bvec3 forward = greaterThan(ray.direction, vec3(0.0));
    vec3 exits = (mix(low, high, forward) - ray.origin) * ray.inverse;
    float leave = min(exits.x, min(exits.y, exits.z)), next = clamp(leave, ray.at, ray.end);
    span.extent = next - ray.at;
    // Along the axis of the exit to the neighbor, whatever rounding says.
    vec3 cell = clamp(floor(ray.origin + next * ray.direction), low, high - 1.0);
    cell = mix(cell, mix(low - 1.0, high, forward), lessThanEqual(exits, vec3(leave)));
    ray.cell = ivec3(cell);
    bool inside = all(greaterThanEqual(cell, vec3(0.0))) && all(lessThan(cell, vec3(ray.voxels)));
    ray.at = inside ? next : ray.end;
    return true;
}

float voxel_channel(GridSpan span, uint channel) {
    uint place = channel * BRICK_VOXELS + span.voxel;
    uint word = imageLoad(MediumVoxels, int(span.brick + place / 2u)).x;
    return half_to_float((place & 1u) == 0u ? word & 0xffffu : word >> 16u);
}

// A coefficient at a voxel by its channels: none, one that scales a color, or three.
vec3 voxel_coefficient(GridSpan span, uint channels, vec3 scale) {
    if (channels == NO_CHANNEL) return vec3(0.0);
    uint first = channels & FIRST_CHANNEL_MASK;
    float value = voxel_channel(span, first);
    if ((channels & THREE_CHANNELS) == 0u) return value * scale;
    return scale * vec3(value, voxel_channel(span, first + 1u), voxel_channel(span, first + 2u));
}

MediumCoefficients span_coefficients(uint medium, GridSpan span) {
    if (span.brick == 0u) return MediumCoefficients(vec3(0.0), vec3(0.0), vec3(0.0));
    uint channels = media[medium].channels;
    return MediumCoefficients(voxel_coefficient(span, channels & 0xffu, media[medium].absorption),
                              voxel_coefficient(span, channels >> 8u & 0xffu, media[medium].scattering),
                              voxel_coefficient(span, channels >> 16u & 0xffu, media[medium].emission));
}

vec3 span_extinction(uint medium, GridSpan span) {
    if (span.brick == 0u) return vec3(0.0);
    uint channels = media[medium].channels;
    return voxel_coefficient(span, channels & 0xffu, media[medium].absorption)
           + voxel_coefficient(span, channels >> 8u & 0xffu, media[medium].scattering);
}

// The coefficients of a grid at a place on a ray.
MediumCoefficients grid_coefficients(uint medium, PlaceOnRay at) {
    vec3 offset = lookup_offset(at.origin, at.direction), place = at.origin + at.distance * at.direction;
    GridRay ray = grid_ray(medium, place, at.direction, 0.0, offset);
    if (ray.start > 0.0 || ray.end < 0.0) return MediumCoefficients(vec3(0.0), vec3(0.0), vec3(0.0));
    return span_coefficients(medium, GridSpan(brick_place(ray), voxel_number(uvec3(ray.cell)), 0.0, 0.0));
}

// Optical thickness of a grid along a ray.
vec3 grid_thickness(uint medium, vec3 origin, vec3 direction, float distance, vec3 offset) {
    GridRay ray = grid_ray(medium, origin, direction, distance, offset);
    vec3 thickness = vec3(0.0);
    GridSpan span;
    while (next_span(ray, span)) thickness += span_extinction(medium, span) * span.extent;
    return thickness;
}

// The distance along a ray at which the optical thickness of a channel comes to a value, by exact inversion;
// INFINITY_DISTANCE where it does not. passed: thickness up to there, or up to the end of the ray.
float grid_free_flight(uint medium, vec3 origin, vec3 direction, float distance, vec3 offset, int channel,
                       float thickness, out vec3 passed) {
    GridRay ray = grid_ray(medium, origin, direction, distance, offset);
    passed = vec3(0.0);
    GridSpan span;
    while (next_span(ray, span)) {
        vec3 extinction = span_extinction(medium, span);
        float rest = thickness - passed[channel];
        if (extinction[channel] * span.extent > rest) {
            float extent = max(rest, 0.0) / extinction[channel];
            passed += extinction * extent;
            return ray.start + span.before + extent;
        }
        passed += extinction * span.extent;
    }
    return INFINITY_DISTANCE;
}

// Radiance that a grid emits along a ray, at its beginning, seen through itself and through media of even extinction.
vec3 grid_emission(uint medium, vec3 origin, vec3 direction, float distance, vec3 offset, vec3 even_extinction) {
    GridRay ray = grid_ray(medium, origin, direction, distance, offset);
    vec3 emitted = vec3(0.0), transmittance = exp(-even_extinction * ray.start);
    GridSpan span;
    while (next_span(ray, span)) {
        MediumCoefficients coefficients = span_coefficients(medium, span);
        vec3 extinction = coefficients.absorption + coefficients.scattering + even_extinction;
        emitted += transmittance * coefficients.emission * seen_length(extinction, span.extent);
        transmittance *= exp(-extinction * span.extent);
    }
    return emitted;
}
#else
bool has_grid(uint medium) { return false; }
#endif
