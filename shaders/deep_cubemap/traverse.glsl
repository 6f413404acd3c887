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
#include "deep_cubemap/state.glsl"
#include "deep_cubemap/cells.glsl"
#include "deep_cubemap/bins.glsl"
#include "deep_cubemap/cell_entry.glsl"
#include "deep_cubemap/core.glsl"
#include "deep_cubemap/clusters.glsl"
#include "deep_cubemap/face_walk.glsl"
#include "deep_cubemap/face_parts.glsl"
#include "deep_cubemap/clipping.glsl"

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
uint entries_read = 0u;
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

// Walks the cells of a face from one distance to another.
void walk_face(CubemapWalk walk, int face, vec2 part, inout Hit best) {
    FaceWalk on_face = enter_face(walk.cubemap, walk.origin, walk.test.direction, face, part);
    // Never reached: a walk crosses 2 * resolution cells at most and changes level for few of them.
    for (int count = 0; count < 60000; ++count) {
        CellView view = view_cell(on_face, walk.cubemap, 0u);
        if (view.is_occupied) {
            if (content_kind(view.cell.content) == CELL_TILE) {
                enter_tile(on_face, view.cell);
                continue;
            }
            test_cell(walk, view.cell, view.depths, vec2(on_face.origin.z, on_face.direction.z), best);
            if (is_done(walk, best, view.exit)) return;
        }
        if (!leave_cell(on_face, walk.cubemap, view)) return;
    }
}

// Walks the faces between two distances, nearest first.
void walk_faces(CubemapWalk walk, float from, float to, inout Hit best) {
    FaceParts parts = clip_to_faces(walk.origin, walk.test.direction, from, to);
    for (int visit = 0; visit < 6; ++visit) {
        vec2 part;
        int face = take_next_face(parts, part);
        if (face < 0 || is_done(walk, best, part.x)) return;
        walk_face(walk, face, part, best);
    }
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
    RayPart whole;
    if (!clip_ray(cubemap, origin, ray.direction, best.distance, whole)) return best;
    float from = whole.from;
    for (int part = 0; part < 2; ++part) {
        float end = part == 0 && whole.meets_core ? whole.core.x : whole.to;
        if (from < end) walk_faces(walk, from, end, best);
        if (part == 1 || !whole.meets_core || is_done(walk, best, whole.core.x)) break;
        for (uint index = 0u; index < cubemap.core_count; ++index) {
            test_triangle(walk.test, core_triangles[index], best);
        }
        from = max(from, whole.core.y);
        if (is_done(walk, best, from)) break;
    }
    return best;
}

// The nearest hit within ray.maximum_distance (which may be it); best.triangle NO_TRIANGLE if none.
Hit nearest_hit(Ray ray) { return trace_ray(ray, false); }

// Whether anything lies within ray.maximum_distance.
bool is_occluded(Ray ray) { return trace_ray(ray, true).triangle != NO_TRIANGLE; }
