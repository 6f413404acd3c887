// SPDX-License-Identifier: GPL-3.0-or-later
// Steps of a ray from cell to cell on a face.
#include "common/whole_numbers.glsl"
#include "deep_cubemap/cells.glsl"
#include "deep_cubemap/faces.glsl"

// The cell at a distance along the ray, which may differ by axis. Where rounding might put it in either
// of two, the one that the ray comes to first: a walk can catch up, but not go back.
ivec2 cell_at(vec3 origin, vec3 direction, vec2 distances, ivec2 steps, float resolution) {
    vec2 depths = max(origin.z + distances * direction.z, vec2(1e-30));
    vec2 error = 3e-7 * (abs(origin.x) + abs(origin.y) + abs(origin.z)) / depths + 2e-7;
    vec2 position = ((origin.xy + distances * direction.xy) / depths - vec2(steps) * error) * 0.5 + 0.5;
    return whole_part(clamp(position * resolution, vec2(0.0), vec2(resolution - 1.0)));
}

// Which way the ray moves across the face along x and y: -1, 0 or 1; 0 where it runs along a plane
// through the center to within rounding, and so stays in one row of cells.
ivec2 step_directions(vec3 origin, vec3 direction) {
    vec2 one = direction.xy * origin.z, other = origin.xy * direction.z;
    bvec2 moves = greaterThan(abs(one - other), 3e-7 * (abs(one) + abs(other)));
    return (ivec2(greaterThan(one, other)) - ivec2(lessThan(one, other))) * ivec2(moves);
}

// A cell's new place along one axis within its block: as computed, but never backwards.
int move_on(int cell, int computed, int step_direction, int first, int last) {
    if (step_direction == 0) return cell;
    return step_direction > 0 ? clamp(computed, cell, last) : clamp(computed, first, cell);
}

ivec2 move_within(ivec2 cell, ivec2 computed, ivec2 steps, ivec2 first, ivec2 last) {
    return ivec2(move_on(cell.x, computed.x, steps.x, first.x, last.x),
                 move_on(cell.y, computed.y, steps.y, first.y, last.y));
}

// Distances, not before `here`, at which the ray crosses the borders of a block of cells that it moves toward.
vec2 border_crossings(vec3 origin, vec3 direction, ivec2 steps, ivec2 block, int level_exponent, float here) {
    vec2 border = cell_border(block + ivec2(greaterThan(steps, ivec2(0))), cell_size(level_exponent));
    vec2 approach = direction.xy - border * direction.z;
    vec2 crossing = max((border * origin.z - origin.xy) / approach, vec2(here));
    // A border counts only if the ray moves toward it; else the ray tends to a vanishing point
    // before the border, and the distance belongs to the ray's other half.
    return mix(vec2(INFINITY_DISTANCE), crossing, greaterThan(vec2(steps) * approach, vec2(0.0)));
}

// Codes of the depths that triangles between two depths may have.
uvec2 depths_between(float near, float far, DeepCubemapState cubemap) {
    return depth_codes(vec2(near - cubemap.margin, far + cubemap.margin), cubemap);
}

const int START_LEVEL = 1;

// findMSB for numbers below 2^24, which not all devices have an instruction for.
int highest_bit(int number) { return (floatBitsToInt(float(number)) >> 23) - 127; }

// First cells of the tiles that were entered, by level from 1 on. No array: those with a variable index lie in memory.
struct TileStack {
    uint at1, at2, at3, at4, at5, at6;
};

void push_tile(inout TileStack tiles, int level, uint tile) {
    tiles.at1 = level == 1 ? tile : tiles.at1;
    tiles.at2 = level == 2 ? tile : tiles.at2;
    tiles.at3 = level == 3 ? tile : tiles.at3;
    tiles.at4 = level == 4 ? tile : tiles.at4;
    tiles.at5 = level == 5 ? tile : tiles.at5;
    tiles.at6 = level == 6 ? tile : tiles.at6;
}

uint tile_at(TileStack tiles, int level) {
    uint low = level == 1 ? tiles.at1 : (level == 2 ? tiles.at2 : tiles.at3);
    uint high = level == 4 ? tiles.at4 : (level == 5 ? tiles.at5 : tiles.at6);
    return level <= 3 ? low : high;
}

// Up to the level whose tile the ray is still in.
void leave_tiles(TileStack tiles, int still_in, inout int level, inout uint tile) {
    if (level > still_in) {
        level = still_in;
        tile = tile_at(tiles, level);
    }
}

// The tile of the start level that a cell lies in.
uint start_tile(int face, ivec2 cell, int finest, int root_exponent) {
    ivec2 start = cell >> (finest - root_exponent - 2 * START_LEVEL);
    return dense_cell_index(face, start, START_LEVEL, 1 << root_exponent) - tile_offset(start);
}
