// SPDX-License-Identifier: GPL-3.0-or-later
// Tracing rays through the deep cubemap; for any kernel: deep_cubemap_hit(ray) and
// deep_cubemap_occluded(ray). Takes the storage block bindings 8 to 13.
//
// Seen from the centre a ray runs through up to six faces, and on each through a row of cells. The
// borders of cells are planes through the centre, so where the ray leaves a cell is a plain ray and
// plane distance. Cells are stepped by whole numbers in a direction that is fixed for a face: rounding
// can neither make the walk loop nor skip a cell.
//
// Mesa's llvmpipe ends all loops of a thread after 65535 rounds in all. Steps and tests of a ray stay
// far below that, unless tens of thousands of triangles crowd into a few cells or around the centre.
#include "common/constants.glsl"
#include "common/finite.glsl"
#include "common/intersection.glsl"
#include "deep_cubemap/triangles.glsl"
#include "deep_cubemap/state.glsl"
#include "deep_cubemap/cells.glsl"
#include "deep_cubemap/bins.glsl"
#include "deep_cubemap/entries.glsl"
#include "deep_cubemap/core.glsl"
#include "deep_cubemap/faces.glsl"

// What stays the same along a ray.
struct CubemapWalk {
    DeepCubemapState cubemap;
    WatertightRay test;
    vec3 origin;          // from the centre
    vec3 direction;
    uint source_triangle; // never hit
    bool any_hit;         // the first hit found will do
};

bool is_done(CubemapWalk walk, Hit best, float distance) {
    return best.distance <= distance || (walk.any_hit && best.triangle != NO_TRIANGLE);
}

void test_triangle(CubemapWalk walk, uint triangle, inout Hit best) {
    if (triangle == walk.source_triangle) return;
    intersect_triangle(
        walk.test, triangle, triangle_vertices[3u * triangle].xyz, triangle_vertices[3u * triangle + 1u].xyz,
        triangle_vertices[3u * triangle + 2u].xyz, best);
}

// Tests what a cell holds between two depths. The bins between them are one stretch of the list.
void test_cell(CubemapWalk walk, CubemapCell cell, vec2 depths, inout Hit best) {
    float near = nearest_depth(cell), far = farthest_depth(cell);
    uint start = bins_start(cell.bins), count = bins_count(cell.bins);
    uvec2 bins = bins_between(depths, near, bin_scale(near, far, count), count);
    uint first = bin_ends[start + bins.x];
    uint first_bin_end = bin_ends[start + bins.x + 1u];
    uint end = bins.y == bins.x ? first_bin_end : bin_ends[start + bins.y + 1u];
    uvec2 wanted = quantise_interval(depths, near, far);
    for (uint place = first; place < end; ++place) {
        uvec2 entry = cell_entries[place];
        if ((entry.y >> 16) < wanted.x || (entry.y & 0xffffu) > wanted.y) continue;
        if (place >= first_bin_end && (entry.x & CONTINUED) != 0u) continue;
        test_triangle(walk, entry.x & ~CONTINUED, best);
        if (walk.any_hit && best.triangle != NO_TRIANGLE) return;
    }
}

ivec2 cell_at(vec3 origin, vec3 direction, float distance, float resolution) {
    vec3 point = origin + distance * direction;
    vec2 position = (point.xy / max(point.z, 1e-30) * 0.5 + 0.5) * resolution;
    return ivec2(clamp(position, vec2(0.0), vec2(resolution - 1.0)));
}

// Which way the ray moves across the face along x and y: -1, 0 or 1; 0 where it runs along a plane
// through the centre to within rounding, and so stays in one row of cells.
ivec2 step_directions(vec3 origin, vec3 direction) {
    vec2 one = direction.xy * origin.z, other = origin.xy * direction.z;
    bvec2 moves = greaterThan(abs(one - other), 3e-7 * (abs(one) + abs(other)));
    return ivec2(sign(one - other)) * ivec2(moves);
}

// A cell's new place along one axis within its block: as computed, but never backwards.
int move_on(int cell, int computed, int step_direction, int first, int last) {
    if (step_direction == 0) return cell;
    return step_direction > 0 ? clamp(computed, cell, last) : clamp(computed, first, cell);
}

// Walks the cells of a face from one distance to another. The place is always a cell; `level` says
// how much around it is looked at together: blocks of 4 x 4 cells and larger are left at once if they
// hold nothing at the ray's depths.
void walk_face(CubemapWalk walk, int face, float enter, float leave, inout Hit best) {
    vec3 origin = to_face(walk.origin, face), direction = to_face(walk.direction, face);
    float resolution = float(walk.cubemap.resolution);
    ivec2 steps = step_directions(origin, direction);
    // A ray that stays in one cell may touch the face's border at its ends: look at its middle.
    float start = steps == ivec2(0) ? 0.5 * (enter + leave) : enter;
    ivec2 cell = cell_at(origin, direction, start, resolution);
    float here = enter;
    int level = int(min(walk.cubemap.top_level, 1u));
    // Never reached: a walk crosses 2 * resolution cells at most and changes level for few of them.
    int most_steps = 8 * int(walk.cubemap.resolution);
    for (int count = 0; count < most_steps; ++count) {
        int shift = 2 * level;
        ivec2 block = cell >> shift;
        vec2 border = cell_border((block + ivec2(greaterThan(steps, ivec2(0)))) << shift, walk.cubemap.cell_size);
        vec2 approach = direction.xy - border * direction.z;
        vec2 crossing = max((border * origin.z - origin.xy) / approach, vec2(here));
        // A border counts only if the ray moves towards it; else the ray tends to a vanishing point
        // before the border, and the distance belongs to the ray's other half.
        crossing = mix(vec2(INFINITY_DISTANCE), crossing, greaterThan(vec2(steps) * approach, vec2(0.0)));
        float exit = min(min(crossing.x, crossing.y), leave);

        vec2 ends = vec2(origin.z + here * direction.z, origin.z + exit * direction.z);
        vec2 depths = vec2(min(ends.x, ends.y) - walk.cubemap.margin, max(ends.x, ends.y) + walk.cubemap.margin);
        CubemapCell content = cubemap_cells[cell_index(face, block, level, walk.cubemap.resolution)];
        bool occupied = (content.slices & depth_slices(depths.x, depths.y, walk.cubemap.slices_per_metre)) != 0u
            && depths.x <= farthest_depth(content) && depths.y >= nearest_depth(content);
        if (occupied && level > 0) {
            --level;
            continue;
        }
        if (occupied) {
            test_cell(walk, content, depths, best);
            if (is_done(walk, best, exit)) return;
        }
        if (exit >= leave) return;

        ivec2 previous = cell;
        ivec2 first = block << shift, last = first + (1 << shift) - 1;
        if (level > 0) {
            // Along the axis that is not crossed the ray has moved on within the block, forwards only.
            ivec2 moved = cell_at(origin, direction, exit, resolution);
            cell.x = move_on(cell.x, moved.x, steps.x, first.x, last.x);
            cell.y = move_on(cell.y, moved.y, steps.y, first.y, last.y);
        }
        if (crossing.x <= crossing.y) {
            cell.x = steps.x > 0 ? last.x + 1 : first.x - 1;
        } else {
            cell.y = steps.y > 0 ? last.y + 1 : first.y - 1;
        }
        if (any(lessThan(cell, ivec2(0))) || any(greaterThanEqual(cell, ivec2(walk.cubemap.resolution)))) return;
        here = exit;
        if (level < int(walk.cubemap.top_level) && previous >> (shift + 2) != cell >> (shift + 2)) ++level;
    }
}

// Part of [from, to] in which the ray is seen through a face. Neighbouring faces compute their common
// border from the same numbers, so that the parts of a ray leave no gap.
bool clip_to_face(vec3 origin, vec3 direction, inout float from, inout float to) {
    vec4 inside = vec4(origin.z - origin.x, origin.z + origin.x, origin.z - origin.y, origin.z + origin.y);
    vec4 slope = vec4(
        direction.z - direction.x, direction.z + direction.x, direction.z - direction.y, direction.z + direction.y);
    vec4 crossing = -inside / slope;
    vec4 entering = mix(vec4(from), crossing, greaterThan(slope, vec4(0.0)));
    vec4 leaving = mix(vec4(to), crossing, lessThan(slope, vec4(0.0)));
    from = max(from, max(max(entering.x, entering.y), max(entering.z, entering.w)));
    to = min(to, min(min(leaving.x, leaving.y), min(leaving.z, leaving.w)));
    // parallel to a border, on its wrong side; not() and bvec logic do not exist, hence products
    vec4 wrong = vec4(equal(slope, vec4(0.0))) * vec4(lessThan(inside, vec4(0.0)));
    return from <= to && wrong == vec4(0.0);
}

// Walks the faces between two distances, nearest first.
void walk_faces(CubemapWalk walk, float from, float to, inout Hit best) {
    float enter[6], leave[6];
    for (int face = 0; face < 6; ++face) {
        enter[face] = from;
        leave[face] = to;
        bool seen = clip_to_face(to_face(walk.origin, face), to_face(walk.direction, face), enter[face], leave[face]);
        if (!seen) enter[face] = INFINITY_DISTANCE;
    }
    for (int visit = 0; visit < 6; ++visit) {
        int next = -1;
        float nearest = INFINITY_DISTANCE, end = 0.0;
        for (int face = 0; face < 6; ++face) {
            if (enter[face] < nearest) {
                nearest = enter[face];
                end = leave[face];
                next = face;
            }
        }
        if (next < 0 || is_done(walk, best, nearest)) return;
        for (int face = 0; face < 6; ++face) {
            if (face == next) enter[face] = INFINITY_DISTANCE;
        }
        walk_face(walk, next, nearest, end, best);
    }
}

// Distances at which the ray is within a radius of the centre; false if it passes outside.
bool clip_to_ball(float closest, float squared_miss, float squared_length, float radius, out vec2 between) {
    float room = radius * radius - squared_miss;
    float half_chord = sqrt(max(room, 0.0) / squared_length);
    between = vec2(closest - half_chord, closest + half_chord);
    return room > 0.0;
}

Hit trace_deep_cubemap(Ray ray, bool any_hit) {
    Hit best = Hit(NO_TRIANGLE, 0.0, 0.0, min(ray.maximum_distance, INFINITY_DISTANCE));
    DeepCubemapState cubemap = deep_cubemap;
    vec3 origin = ray.origin - cubemap.centre;
    float squared_length = dot(ray.direction, ray.direction);
    if (!(ray.maximum_distance > 0.0) || !is_finite(origin) || !is_finite(ray.direction) || squared_length == 0.0) {
        return best;
    }
    CubemapWalk walk = CubemapWalk(
        cubemap, make_watertight_ray(ray.origin, ray.direction), origin, ray.direction, ray.source_triangle, any_hit);
    float closest = -dot(origin, ray.direction) / squared_length;
    vec3 foot = origin + closest * ray.direction;
    float squared_miss = dot(foot, foot);
    // All triangles are in the scene's ball; what is left of the ray outside need not be walked.
    float scene_radius = 1.001 * cubemap.scene_radius + 1e-5 * length(origin);
    vec2 scene, core;
    if (!clip_to_ball(closest, squared_miss, squared_length, scene_radius, scene)) return best;
    float from = max(scene.x, 0.0), to = min(scene.y, best.distance);
    if (!(from < to)) return best;

    // Near the centre the ray tests the core list, and walks cells only before and after that.
    bool meets_core = clip_to_ball(closest, squared_miss, squared_length, cubemap.core_radius, core)
        && core.y > from && core.x < to;
    for (int part = 0; part < 2; ++part) {
        float end = part == 0 && meets_core ? core.x : to;
        if (from < end) walk_faces(walk, from, end, best);
        if (part == 1 || !meets_core || is_done(walk, best, core.x)) break;
        for (uint index = 0u; index < cubemap.core_count; ++index) {
            test_triangle(walk, core_triangles[index], best);
        }
        from = max(from, core.y);
        if (is_done(walk, best, from)) break;
    }
    return best;
}

// The nearest hit within ray.maximum_distance (which may be it); best.triangle NO_TRIANGLE if none.
Hit deep_cubemap_hit(Ray ray) {
    return trace_deep_cubemap(ray, false);
}

// Whether anything lies within ray.maximum_distance.
bool deep_cubemap_occluded(Ray ray) {
    return trace_deep_cubemap(ray, true).triangle != NO_TRIANGLE;
}
