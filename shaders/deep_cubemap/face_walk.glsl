// SPDX-License-Identifier: GPL-3.0-or-later
// A ray on its way through the cells of a face, from one distance to another.
#include "deep_cubemap/cell_steps.glsl"
#include "deep_cubemap/faces.glsl"

#ifdef COUNT_TRAVERSAL
uint walk_steps = 0u;
#endif

// The place is always one of the finest cells; `level` says how much around it is looked at together: a cell that is
// divided, or that holds nothing at the ray's depths, is left at once.
struct FaceWalk {
    vec3 origin, direction;  // as the face has them
    int face;
    ivec2 steps;
    ivec2 cell;
    float here, leave;
    TileStack tiles;
    int level;
    uint tile;  // the first cell of the tile, of the cubemap's own cells
};

// The cell around the place that is looked at, and the ray in it.
struct CellView {
    CubemapCell cell;
    uvec2 depths;   // codes
    vec2 crossing;  // distances to the cell's borders
    float exit;
    bool is_occupied;
};

int finest_exponent(DeepCubemapState cubemap) { return int(cubemap.root_exponent) + 2 * int(cubemap.last_level); }

// part: the distances at which the ray enters and leaves the face. origin: from the center.
FaceWalk enter_face(DeepCubemapState cubemap, vec3 origin, vec3 direction, int face, vec2 part) {
    FaceWalk walk;
    walk.origin = to_face(origin, face);
    walk.direction = to_face(direction, face);
    walk.face = face;
    walk.steps = step_directions(walk.origin, walk.direction);
    // A ray that stays in one row is nowhere more exact than where it is farthest from the center.
    vec2 starts = mix(vec2(part.x), vec2(walk.direction.z > 0.0 ? part.y : part.x), equal(walk.steps, ivec2(0)));
    int finest = finest_exponent(cubemap);
    walk.cell = cell_at(walk.origin, walk.direction, starts, walk.steps, float(1 << finest));
    walk.here = part.x;
    walk.leave = part.y;
    walk.tiles = TileStack(0u, 0u, 0u, 0u, 0u, 0u);
    walk.level = START_LEVEL;
    walk.tile = start_tile(face, walk.cell, finest, int(cubemap.root_exponent));
    return walk;
}

int block_shift(FaceWalk walk, DeepCubemapState cubemap) { return 2 * (int(cubemap.last_level) - walk.level); }

// first_cell: of the cubemap, in the block CubemapCells.
CellView view_cell(FaceWalk walk, DeepCubemapState cubemap, uint first_cell) {
#ifdef COUNT_TRAVERSAL
    ++walk_steps;
#endif
    CellView view;
    ivec2 block = walk.cell >> block_shift(walk, cubemap);
    int exponent = int(cubemap.root_exponent) + 2 * walk.level;
    view.crossing = border_crossings(walk.origin, walk.direction, walk.steps, block, exponent, walk.here);
    view.exit = min(min(view.crossing.x, view.crossing.y), walk.leave);
    vec2 ends = walk.origin.z + vec2(walk.here, view.exit) * walk.direction.z;
    view.depths = depths_between(min(ends.x, ends.y), max(ends.x, ends.y), cubemap);
    CubemapCell cell = cubemap_cell(first_cell + walk.tile + tile_offset(block));
    view.cell = cell;
    view.is_occupied = view.depths.x <= cell.far && view.depths.y >= ~cell.near_complement
                       && (cell.slices & depth_slices(view.depths, cell)) != 0u;
    return view;
}

// Down to the smaller cells of a cell that is divided.
void enter_tile(inout FaceWalk walk, CubemapCell cell) {
    push_tile(walk.tiles, walk.level, walk.tile);
    ++walk.level;
    walk.tile = content_tile(cell.content);
}

// On to the cell behind; false where the ray leaves the face.
bool leave_cell(inout FaceWalk walk, DeepCubemapState cubemap, CellView view) {
    if (view.exit >= walk.leave) return false;
    int finest = finest_exponent(cubemap), shift = block_shift(walk, cubemap);
    ivec2 block = walk.cell >> shift, cell = walk.cell;
    ivec2 first = block << shift, last = first + (1 << shift) - 1;
    // Along the axis that is not crossed the ray has moved on within the block, forwards only.
    if (shift > 0) {
        ivec2 computed = cell_at(walk.origin, walk.direction, vec2(view.exit), walk.steps, float(1 << finest));
        cell = move_within(cell, computed, walk.steps, first, last);
    }
    if (view.crossing.x <= view.crossing.y) {
        cell.x = walk.steps.x > 0 ? last.x + 1 : first.x - 1;
    } else {
        cell.y = walk.steps.y > 0 ? last.y + 1 : first.y - 1;
    }
    if (any(lessThan(cell, ivec2(0))) || any(greaterThanEqual(cell, ivec2(1 << finest)))) return false;
    int root_exponent = int(cubemap.root_exponent);
    int changed = highest_bit((walk.cell.x ^ cell.x) | (walk.cell.y ^ cell.y));
    walk.cell = cell;
    walk.here = view.exit;
    leave_tiles(walk.tiles, (finest - root_exponent + 1 - changed) >> 1, walk.level, walk.tile);
    if (walk.level <= START_LEVEL) {
        walk.level = START_LEVEL;
        walk.tile = start_tile(walk.face, cell, finest, root_exponent);
    }
    return true;
}
