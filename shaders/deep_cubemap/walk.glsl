// SPDX-License-Identifier: GPL-3.0-or-later
// Walks through one of several deep cubemaps, whose cells, entries and lists lie behind one another in the same blocks.
// GLSL has no function pointers: a walk hands out what it comes to, list by list and item by item, and whoever walks
// tests it. Which lists and steps there are is the same as in traverse.glsl.
#include <DeepCubemapState>
#include "deep_cubemap/cells.glsl"
#include "deep_cubemap/bins.glsl"
#include "deep_cubemap/cell_entry.glsl"
#include "deep_cubemap/face_walk.glsl"
#include "deep_cubemap/face_parts.glsl"
#include "deep_cubemap/clipping.glsl"

#ifdef COUNT_TRAVERSAL
uint entries_read = 0u;
#endif

const int BEFORE_CORE = 0, IN_CORE = 1, BEHIND_CORE = 2;

struct CubemapWalk {
    DeepCubemapState cubemap;
    vec3 origin, direction;  // from the center
    RayPart left;            // of the ray
    int part;
    bool has_faces;  // of the part
    FaceParts faces;
    bool is_on_face;
    FaceWalk face;
};

// A list that a walk has come to, and how far it has been read.
struct CellItems {
    CubemapCell cell;
    vec2 depth;  // of the ray's origin, and its slope
    float exit;  // the distance at which the ray leaves the cell
    uvec2 wanted;
    uint place, end;
    int bin, bins_left;
    uint visited_flag;
    bool is_core;
};

// to: the distance up to which the ray is walked. Returns false where it misses all that the cubemap holds.
bool begin_walk(DeepCubemapState cubemap, vec3 origin, vec3 direction, float to, out CubemapWalk walk) {
    walk.cubemap = cubemap;
    walk.origin = origin;
    walk.direction = direction;
    if (!clip_ray(cubemap, origin, direction, to, walk.left)) return false;
    walk.part = BEFORE_CORE;
    walk.has_faces = false;
    walk.is_on_face = false;
    return true;
}

CellItems core_items(CubemapWalk walk) {
    CellItems items;
    items.is_core = true;
    items.place = walk.cubemap.first_core;
    items.end = items.place + walk.cubemap.core_count;
    items.bins_left = 0;
    items.exit = max(walk.left.from, walk.left.core.y);
    return items;
}

void read_bin(CubemapWalk walk, inout CellItems items) {
    uint bin = walk.cubemap.first_bin + content_start(items.cell.content) + uint(items.bin);
    items.place = walk.cubemap.first_entry + bin_ends[bin];
    items.end = walk.cubemap.first_entry + bin_ends[bin + 1u];
}

CellItems cell_items(CubemapWalk walk, CellView view) {
    CellItems items;
    items.is_core = false;
    items.cell = view.cell;
    items.depth = vec2(walk.face.origin.z, walk.face.direction.z);
    items.exit = view.exit;
    items.wanted = quantize_interval(view.depths, view.cell);
    items.bins_left = 0;
    items.visited_flag = 0u;
    if (content_kind(view.cell.content) == CELL_BINS) {
        ivec2 bins = bins_between(view.depths, view.cell);
        items.bin = items.depth.y >= 0.0 ? bins.x : bins.y;
        items.bins_left = bins.y - bins.x;
        read_bin(walk, items);
    } else {
        items.place = walk.cubemap.first_entry + content_start(view.cell.content);
        items.end = items.place + content_count(view.cell.content);
    }
    return items;
}

// On to the next face, or to the next part of the ray. Returns false where there is none before a distance.
bool next_face(inout CubemapWalk walk, float nearest) {
    if (!walk.has_faces) {
        float end = walk.part == BEFORE_CORE && walk.left.meets_core ? walk.left.core.x : walk.left.to;
        walk.faces = clip_to_faces(walk.origin, walk.direction, walk.left.from, end);
        walk.has_faces = true;
        if (!(walk.left.from < end)) return false;
    }
    vec2 part;
    int face = take_next_face(walk.faces, part);
    if (face < 0 || nearest <= part.x) return false;
    walk.face = enter_face(walk.cubemap, walk.origin, walk.direction, face, part);
    walk.is_on_face = true;
    return true;
}

// Whether the walk comes to another list before the distance of the nearest hit.
bool next_items(inout CubemapWalk walk, float nearest, out CellItems items) {
    // Never reached: a walk crosses some thousand cells at most.
    for (int count = 0; count < 60000; ++count) {
        if (walk.is_on_face) {
            CellView view = view_cell(walk.face, walk.cubemap, walk.cubemap.first_cell);
            if (view.is_occupied && content_kind(view.cell.content) == CELL_TILE) {
                enter_tile(walk.face, view.cell);
                continue;
            }
            if (view.is_occupied) items = cell_items(walk, view);
            walk.is_on_face = leave_cell(walk.face, walk.cubemap, view);
            if (view.is_occupied) return true;
        } else if (walk.part == IN_CORE) {
            walk.left.from = max(walk.left.from, walk.left.core.y);
            if (nearest <= walk.left.from) return false;
            walk.part = BEHIND_CORE;
            walk.has_faces = false;
        } else if (!next_face(walk, nearest)) {
            if (walk.part == BEHIND_CORE || !walk.left.meets_core || nearest <= walk.left.core.x) return false;
            walk.part = IN_CORE;
            items = core_items(walk);
            return true;
        }
    }
    return false;
}

// Whether the list has another item, cut short by the distance of the nearest hit. Items of cells are triangles, or
// clusters, or instances as the cubemap was built of; those of the core triangles or instances.
bool next_item(CubemapWalk walk, inout CellItems items, float nearest, out uint item) {
    while (true) {
        while (items.place < items.end) {
            uint place = items.place++;
            if (items.is_core) {
                item = bin_ends[place];
                return true;
            }
#ifdef COUNT_TRAVERSAL
            ++entries_read;
#endif
            uvec2 entry = cell_entry(place);
            bool is_wanted = (entry.y >> 16) >= items.wanted.x && (entry.y & 0xffffu) <= items.wanted.y;
            if (is_wanted && (entry.x & items.visited_flag) == 0u) {
                item = entry.x & ENTRY_TRIANGLE;
                return true;
            }
        }
        if (items.bins_left <= 0) return false;
        --items.bins_left;
        // A hit ends the ray before the bins that lie behind it.
        bool outwards = items.depth.y >= 0.0;
        float hit_depth = items.depth.x + nearest * items.depth.y, margin = walk.cubemap.margin;
        uvec2 codes = depth_codes(hit_depth + vec2(-1.0, 1.0) * margin, walk.cubemap);
        ivec2 hit_bins = bins_between(codes, items.cell);
        if (outwards ? hit_bins.y <= items.bin : hit_bins.x >= items.bin) return false;
        items.visited_flag = outwards ? ENTRY_IN_BIN_BEFORE : ENTRY_IN_BIN_BEHIND;
        items.bin += outwards ? 1 : -1;
        read_bin(walk, items);
    }
}
