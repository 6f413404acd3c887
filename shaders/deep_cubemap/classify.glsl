// SPDX-License-Identifier: GPL-3.0-or-later
// One cell of a job: the exact test, and the fragment it leaves behind.
#include "deep_cubemap/triangles.glsl"
#include "deep_cubemap/state.glsl"
#include "deep_cubemap/cells.glsl"
#include "deep_cubemap/fragments.glsl"
#include "deep_cubemap/faces.glsl"
#include "deep_cubemap/cone_overlap.glsl"

void classify_cell(uint triangle, int face, ivec2 cell) {
    vec3 a = to_face(triangle_vertices[3u * triangle].xyz - deep_cubemap.centre, face);
    vec3 b = to_face(triangle_vertices[3u * triangle + 1u].xyz - deep_cubemap.centre, face);
    vec3 c = to_face(triangle_vertices[3u * triangle + 2u].xyz - deep_cubemap.centre, face);
    vec2 depths;
    if (!cone_depths(a, b, c, cell_bounds(cell, deep_cubemap.cell_size), deep_cubemap.margin, depths)) return;
    uint index = cell_index(face, cell, 0, deep_cubemap.resolution);
    atomicMax(cubemap_cells[index].near_complement, ~floatBitsToUint(depths.x));
    atomicMax(cubemap_cells[index].far, floatBitsToUint(depths.y));
    atomicOr(cubemap_cells[index].slices, depth_slices(depths.x, depths.y, deep_cubemap.slices_per_metre));
    atomicAdd(cubemap_cells[index].bins, 1u);
    // counted past the capacity as well, so that the host learns how much is needed
    uint slot = atomicAdd(deep_cubemap.fragment_count, 1u);
    if (slot < deep_cubemap.fragment_capacity) {
        overlap_fragments[slot] = OverlapFragment(index, triangle, depths.x, depths.y);
    }
}
