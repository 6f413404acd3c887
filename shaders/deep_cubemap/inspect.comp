#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint: TRAVERSAL=deep_cubemap/traverse.glsl COUNT_TRAVERSAL=1
// lint: TRAVERSAL=deep_cubemap/traverse_two_levels.glsl COUNT_TRAVERSAL=1 CUBEMAP_LEVELS=1
// What the rays through the pixels cost: (steps, triangle tests, entries in the cell of the hit, entries read).
layout(local_size_x = 64) in;
#include "common/invocation.glsl"
#include TRAVERSAL

restrict readonly buffer Camera;
restrict writeonly buffer Inspections { vec4 inspections[]; };
#include "camera_paths/gbuffer/panorama.glsl"

// Triangles, or instances, listed in the leaf that a point, from the center, lies in; those in several depth bins count
// as often.
uint listed_in(DeepCubemapState cubemap, vec3 point) {
    if (cubemap.root_count == 0u) return cubemap.core_count;
    vec3 size = abs(point);
    int axis = size.x >= max(size.y, size.z) ? 0 : (size.y >= size.z ? 1 : 2);
    int face = 2 * axis + (point[axis] < 0.0 ? 1 : 0);
    vec3 on_face = to_face(point, face);
    int root_exponent = int(cubemap.root_exponent), levels = int(cubemap.last_level);
    float resolution = float(1 << (root_exponent + 2 * levels));
    ivec2 finest = ivec2(clamp((on_face.xy / max(on_face.z, 1e-30) * 0.5 + 0.5) * resolution, 0.0, resolution - 1.0));
    uint index = dense_cell_index(face, finest >> (2 * levels), 0, 1 << root_exponent);
    for (int level = 1; level <= levels; ++level) {
        uint content = cubemap_cell(cubemap.first_cell + index).content;
        if (content_kind(content) != CELL_TILE) break;
        index = content_tile(content) + tile_offset(finest >> (2 * (levels - level)));
    }
    CubemapCell cell = cubemap_cell(cubemap.first_cell + index);
    if (content_kind(cell.content) != CELL_BINS) return content_count(cell.content);
    uint start = cubemap.first_bin + content_start(cell.content);
    return bin_ends[start + uint(bins_total(cell))] - bin_ends[start];
}

uint listed_at(vec3 place) {
#ifdef CUBEMAP_LEVELS
    DeepCubemapState world = deep_cubemaps[WORLD_LEVEL], of_instances = deep_cubemaps[INSTANCE_LEVEL];
    return listed_in(world, place - world.center) + listed_in(of_instances, place - of_instances.center);
#else
    return listed_in(deep_cubemap, place - deep_cubemap.center);
#endif
}

void main() {
    uint index = invocation_index();
    if (index >= camera.width * camera.height) return;
    vec2 at = window_point(index), center = vec2(0.0);
    Ray ray =
        world_ray(camera.projection <= PROJECTION_ORTHOGRAPHIC ? plane_ray(at, center) : panorama_ray(at, center));
    Hit hit = nearest_hit(ray);
    uint listed = hit.triangle == NO_TRIANGLE ? 0u : listed_at(ray.origin + hit.distance * ray.direction);
    inspections[index] = vec4(walk_steps, triangle_tests, listed, entries_read);
}
