// SPDX-License-Identifier: GPL-3.0-or-later
// Tracing rays through the deep cubemap, for kernels that include TRAVERSAL.
//
// Seen from the center a ray runs through up to six faces, and on each through a row of cells. The
// borders of cells are planes through the center, so where the ray leaves a cell is a plain ray and
// plane distance. Cells are stepped by whole numbers in a direction that is fixed for a face: rounding
// can neither make the walk loop nor skip a cell.
//
// Mesa's llvmpipe ends all loops of a thread after 65535 rounds in all. Steps and tests of a ray stay
// far below that, unless tens of thousands of triangles crowd into a few cells or around the center.
#include "acceleration/one_level.glsl"
#include "acceleration/ray_test.glsl"
#include "common/finite.glsl"
#include "common/whole_numbers.glsl"
#include "deep_cubemap/state.glsl"
#include "deep_cubemap/cells.glsl"
#include "deep_cubemap/bins.glsl"
#include "deep_cubemap/cell_entry.glsl"
#include "deep_cubemap/core.glsl"
#include "deep_cubemap/clusters.glsl"
#include "deep_cubemap/faces.glsl"

// What stays the same along a ray.
struct CubemapWalk {
    DeepCubemapState cubemap;
    RayTest test;
    vec3 origin;  // from the center
};

bool is_done(CubemapWalk walk, Hit best, float distance) {
    return best.distance <= distance || (walk.test.any_hit && best.triangle != NO_TRIANGLE);
}

#ifdef COUNT_TRAVERSAL
uint walk_steps = 0u, entries_read = 0u;
#endif

// Tests what a cell holds between two depths; cells with depth bins in the ray's order.
// `depth`: at the ray's origin, and its slope.
void test_cell(CubemapWalk walk, CubemapCell cell, uvec2 depths, vec2 depth, inout Hit best) {
    uint start = content_start(cell.content), first = start, end = start + content_count(cell.content);
    uvec2 wanted = quantize_interval(depths, cell);
    bool outwards = depth.y >= 0.0;
    ivec2 bins = ivec2(0);
    int bin = 0;
    uint visited_flag = 0u;
    if (content_kind(cell.content) == CELL_BINS) {
        bins = bins_between(depths, cell);
        bin = outwards ? bins.x : bins.y;
        first = bin_ends[start + uint(bin)];
        end = bin_ends[start + uint(bin) + 1u];
    }
    for (int remaining = bins.y - bins.x;; --remaining) {
        uint place = first;
#ifdef TRIANGLE_CLUSTERS
        uint next = 0u, behind = 0u;  // of the cluster that is being tested
#endif
        while (true) {
            // on to the next candidate first: the threads of a group then test theirs together
            uint triangle = NO_TRIANGLE;
#ifdef TRIANGLE_CLUSTERS
            if (next < behind) triangle = next++;
#endif
            for (; place < end && triangle == NO_TRIANGLE; ++place) {
#ifdef COUNT_TRAVERSAL
                ++entries_read;
#endif
                uvec2 entry = cell_entry(place);
                if ((entry.y >> 16) >= wanted.x && (entry.y & 0xffffu) <= wanted.y && (entry.x & visited_flag) == 0u) {
                    triangle = cluster_first(entry.x & ENTRY_TRIANGLE);
#ifdef TRIANGLE_CLUSTERS
                    next = triangle + 1u;
                    behind = triangle + cluster_size(entry.x & ENTRY_TRIANGLE);
#endif
                }
            }
            if (triangle == NO_TRIANGLE) break;
            test_triangle(walk.test, triangle, best);
        }
        if (remaining <= 0) return;
        if (best.triangle != NO_TRIANGLE) {
            if (walk.test.any_hit) return;
            // a hit ends the ray before the bins that lie behind it
            float hit_depth = depth.x + best.distance * depth.y;
            ivec2 hit_bins =
                bins_between(depth_codes(hit_depth + vec2(-1.0, 1.0) * walk.cubemap.margin, walk.cubemap), cell);
            if (outwards ? hit_bins.y <= bin : hit_bins.x >= bin) return;
        }
        visited_flag = outwards ? ENTRY_IN_BIN_BEFORE : ENTRY_IN_BIN_BEHIND;
        bin += outwards ? 1 : -1;
        first = bin_ends[start + uint(bin)];
        end = bin_ends[start + uint(bin) + 1u];
    }
}

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

// Walks the cells of a face from one distance to another. The place is always one of the finest cells;
// `level` says how much around it is looked at together: a cell that is divided, or that holds nothing
// at the ray's depths, is left at once.
void walk_face(CubemapWalk walk, int face, float enter, float leave, inout Hit best) {
    vec3 origin = to_face(walk.origin, face), direction = to_face(walk.test.direction, face);
    int root_exponent = int(walk.cubemap.root_exponent);
    int finest = root_exponent + 2 * int(walk.cubemap.last_level);
    float resolution = float(1 << finest);
    ivec2 steps = step_directions(origin, direction);
    // A ray that stays in one row is nowhere more exact than where it is farthest from the center.
    vec2 starts = mix(vec2(enter), vec2(direction.z > 0.0 ? leave : enter), equal(steps, ivec2(0)));
    ivec2 cell = cell_at(origin, direction, starts, steps, resolution);
    float here = enter;
    TileStack tiles = TileStack(0u, 0u, 0u, 0u, 0u, 0u);
    int level = START_LEVEL;
    uint tile = start_tile(face, cell, finest, root_exponent);
    // Never reached: a walk crosses 2 * resolution cells at most and changes level for few of them.
    for (int count = 0; count < 60000; ++count) {
#ifdef COUNT_TRAVERSAL
        ++walk_steps;
#endif
        int shift = finest - root_exponent - 2 * level;
        ivec2 block = cell >> shift;
        vec2 crossing = border_crossings(origin, direction, steps, block, root_exponent + 2 * level, here);
        float exit = min(min(crossing.x, crossing.y), leave);

        vec2 ends = vec2(origin.z + here * direction.z, origin.z + exit * direction.z);
        uvec2 depths = depths_between(min(ends.x, ends.y), max(ends.x, ends.y), walk.cubemap);
        CubemapCell content = cubemap_cell(tile + tile_offset(block));
        bool occupied = depths.x <= content.far && depths.y >= ~content.near_complement
                        && (content.slices & depth_slices(depths, content)) != 0u;
        if (occupied) {
            if (content_kind(content.content) == CELL_TILE) {
                push_tile(tiles, level, tile);
                ++level;
                tile = content_tile(content.content);
                continue;
            }
            test_cell(walk, content, depths, vec2(origin.z, direction.z), best);
            if (is_done(walk, best, exit)) return;
        }
        if (exit >= leave) return;

        ivec2 previous = cell;
        ivec2 first = block << shift, last = first + (1 << shift) - 1;
        // Along the axis that is not crossed the ray has moved on within the block, forwards only.
        if (shift > 0)
            cell = move_within(cell, cell_at(origin, direction, vec2(exit), steps, resolution), steps, first, last);
        if (crossing.x <= crossing.y) {
            cell.x = steps.x > 0 ? last.x + 1 : first.x - 1;
        } else {
            cell.y = steps.y > 0 ? last.y + 1 : first.y - 1;
        }
        if (any(lessThan(cell, ivec2(0))) || any(greaterThanEqual(cell, ivec2(1 << finest)))) return;
        here = exit;
        int changed = highest_bit((previous.x ^ cell.x) | (previous.y ^ cell.y));
        leave_tiles(tiles, (finest - root_exponent + 1 - changed) >> 1, level, tile);
        if (level <= START_LEVEL) {
            level = START_LEVEL;
            tile = start_tile(face, cell, finest, root_exponent);
        }
    }
}

// The parts of a ray seen through the faces: enter and leave of those along +x, +y, +z and along -x, -y, -z.
// The faces meet in six planes through the center, and neighbors take their common border from the same
// number, so that the parts leave no gap.
struct FaceParts {
    vec3 enter_positive, leave_positive, enter_negative, leave_negative;
};

FaceParts clip_to_faces(vec3 origin, vec3 direction, float from, float to) {
    // x - y, y - z, z - x and their sums
    vec3 difference = origin - origin.yzx, difference_slope = direction - direction.yzx;
    vec3 sum = origin + origin.yzx, sum_slope = direction + direction.yzx;
    vec3 difference_zero = -difference / difference_slope, sum_zero = -sum / sum_slope;
    vec3 never = vec3(INFINITY_DISTANCE), always = vec3(-INFINITY_DISTANCE);
    // from where on the difference is positive, or negative; a constant one is so always or never
    vec3 rise = mix(mix(always, difference_zero, greaterThan(difference_slope, vec3(0.0))), never,
                    bvec3(vec3(equal(difference_slope, vec3(0.0))) * vec3(lessThan(difference, vec3(0.0)))));
    vec3 fall = mix(mix(always, difference_zero, lessThan(difference_slope, vec3(0.0))), never,
                    bvec3(vec3(equal(difference_slope, vec3(0.0))) * vec3(greaterThan(difference, vec3(0.0)))));
    vec3 sum_rise = mix(mix(always, sum_zero, greaterThan(sum_slope, vec3(0.0))), never,
                        bvec3(vec3(equal(sum_slope, vec3(0.0))) * vec3(lessThan(sum, vec3(0.0)))));
    vec3 sum_fall = mix(mix(always, sum_zero, lessThan(sum_slope, vec3(0.0))), never,
                        bvec3(vec3(equal(sum_slope, vec3(0.0))) * vec3(greaterThan(sum, vec3(0.0)))));
    // until where: as long as the opposite has not begun
    vec3 rise_end = mix(never, difference_zero, lessThan(difference_slope, vec3(0.0)));
    vec3 fall_end = mix(never, difference_zero, greaterThan(difference_slope, vec3(0.0)));
    vec3 sum_rise_end = mix(never, sum_zero, lessThan(sum_slope, vec3(0.0)));
    vec3 sum_fall_end = mix(never, sum_zero, greaterThan(sum_slope, vec3(0.0)));
    FaceParts parts;
    parts.enter_positive = max(max(max(rise, fall.zxy), max(sum_rise, sum_rise.zxy)), vec3(from));
    parts.leave_positive = min(min(min(rise_end, fall_end.zxy), min(sum_rise_end, sum_rise_end.zxy)), vec3(to));
    parts.enter_negative = max(max(max(fall, rise.zxy), max(sum_fall, sum_fall.zxy)), vec3(from));
    parts.leave_negative = min(min(min(fall_end, rise_end.zxy), min(sum_fall_end, sum_fall_end.zxy)), vec3(to));
    // faces that are not seen come last
    parts.enter_positive = mix(parts.enter_positive, never, greaterThan(parts.enter_positive, parts.leave_positive));
    parts.enter_negative = mix(parts.enter_negative, never, greaterThan(parts.enter_negative, parts.leave_negative));
    return parts;
}

// Takes the face that the ray sees next out of the parts: (enter, leave); -1 if there is none.
int take_next_face(inout FaceParts parts, out vec2 part) {
    vec3 nearest = min(parts.enter_positive, parts.enter_negative);
    float enter = min(nearest.x, min(nearest.y, nearest.z));
    if (enter >= INFINITY_DISTANCE) return -1;
    int axis = nearest.x == enter ? 0 : (nearest.y == enter ? 1 : 2);
    bvec3 chosen = equal(ivec3(axis), ivec3(0, 1, 2));
    bool positive = parts.enter_positive[axis] == enter;
    part = vec2(enter, positive ? parts.leave_positive[axis] : parts.leave_negative[axis]);
    if (positive) {
        parts.enter_positive = mix(parts.enter_positive, vec3(INFINITY_DISTANCE), chosen);
    } else {
        parts.enter_negative = mix(parts.enter_negative, vec3(INFINITY_DISTANCE), chosen);
    }
    return 2 * axis + (positive ? 0 : 1);
}

// Walks the faces between two distances, nearest first.
void walk_faces(CubemapWalk walk, float from, float to, inout Hit best) {
    FaceParts parts = clip_to_faces(walk.origin, walk.test.direction, from, to);
    for (int visit = 0; visit < 6; ++visit) {
        vec2 part;
        int face = take_next_face(parts, part);
        if (face < 0 || is_done(walk, best, part.x)) return;
        walk_face(walk, face, part.x, part.y, best);
    }
}

// Distances at which the ray is within a radius of the center; false if it passes outside.
bool clip_to_ball(float closest, float squared_miss, float squared_length, float radius, out vec2 between) {
    float room = radius * radius - squared_miss;
    float half_chord = sqrt(max(room, 0.0) / squared_length);
    between = vec2(closest - half_chord, closest + half_chord);
    return room > 0.0;
}

// Part of [from, to] within the box around all triangles; axes along which the ray hardly moves are left aside.
void clip_to_box(CubemapWalk walk, inout float from, inout float to) {
    vec3 low = from_sortable_bits(~walk.cubemap.low_complement) - walk.cubemap.margin;
    vec3 high = from_sortable_bits(walk.cubemap.high) + walk.cubemap.margin;
    bvec3 moves = greaterThan(abs(walk.test.direction), vec3(1e-20));
    vec3 a = (low - walk.origin) / walk.test.direction, b = (high - walk.origin) / walk.test.direction;
    vec3 enter = mix(vec3(from), min(a, b), moves), leave = mix(vec3(to), max(a, b), moves);
    from = max(from, max(enter.x, max(enter.y, enter.z)));
    to = min(to, min(leave.x, min(leave.y, leave.z)));
}

Hit trace_ray(Ray ray, bool any_hit) {
    Hit best = Hit(NO_TRIANGLE, 0.0, 0.0, min(ray.maximum_distance, INFINITY_DISTANCE));
    DeepCubemapState cubemap = deep_cubemap;
    vec3 origin = ray.origin - cubemap.center;
    float squared_length = dot(ray.direction, ray.direction);
    if (!(ray.maximum_distance > 0.0) || !is_finite(origin) || !is_finite(ray.direction) || squared_length == 0.0) {
        return best;
    }
    CubemapWalk walk = CubemapWalk(cubemap, make_ray_test(ray, any_hit), origin);
    float closest = -dot(origin, ray.direction) / squared_length;
    vec3 foot = origin + closest * ray.direction;
    float squared_miss = dot(foot, foot);
    // All triangles are in the scene's ball; what is left of the ray outside need not be walked.
    float scene_radius = 1.001 * cubemap.scene_radius + 1e-5 * length(origin);
    vec2 scene, core;
    if (!clip_to_ball(closest, squared_miss, squared_length, scene_radius, scene)) return best;
    float from = max(scene.x, 0.0), to = min(scene.y, best.distance);
    clip_to_box(walk, from, to);
    if (!(from < to)) return best;

    // Near the center the ray tests the core list, and walks cells only before and after that.
    bool meets_core =
        clip_to_ball(closest, squared_miss, squared_length, cubemap.core_radius, core) && core.y > from && core.x < to;
    for (int part = 0; part < 2; ++part) {
        float end = part == 0 && meets_core ? core.x : to;
        if (from < end) walk_faces(walk, from, end, best);
        if (part == 1 || !meets_core || is_done(walk, best, core.x)) break;
        for (uint index = 0u; index < cubemap.core_count; ++index) {
            test_triangle(walk.test, core_triangles[index], best);
        }
        from = max(from, core.y);
        if (is_done(walk, best, from)) break;
    }
    return best;
}

// The nearest hit within ray.maximum_distance (which may be it); best.triangle NO_TRIANGLE if none.
Hit nearest_hit(Ray ray) { return trace_ray(ray, false); }

// Whether anything lies within ray.maximum_distance.
bool is_occluded(Ray ray) { return trace_ray(ray, true).triangle != NO_TRIANGLE; }
