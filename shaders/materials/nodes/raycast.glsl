// SPDX-License-Identifier: GPL-3.0-or-later
// What a ray from anywhere meets first, as Cycles has it: distances are in lengths of the direction, and normals on the
// side that the ray comes from. Worlds and lights meet nothing.

void node_raycast(Surface surface, int only_local, uint place, uint level, vec3 position, vec3 direction, float reach,
                  out float is_hit, out float self_hit, out float hit_distance, out vec3 hit_position,
                  out vec3 hit_normal, out vec3 hit_triangle, out vec3 hit_barycentrics) {
    is_hit = self_hit = 0.0;
    hit_distance = reach;
    hit_position = hit_normal = hit_triangle = hit_barycentrics = vec3(0.0);
#ifdef NODE_RAYS
    float size = length(direction);
    if (parameters.ray_stride > 0u && reach > 0.0 && size > 0.0) {
        uint kind = only_local != 0 ? QUERY_LOCAL_RAYCAST : QUERY_RAYCAST;
        bool from_surface = position == world_position(surface);
        if (from_surface) kind |= QUERY_FROM_SURFACE;
        vec3 normal = found_by_rays(place, level, kind, 1u, direction / size, reach * size);
        uint beside = parameters.ray_stride * path_of_node_rays + place + 1u;
        if (parameters.ray_level == level)
            node_rays[beside].direction = from_surface ? surface.position : position - parameters.world_origin;
        vec3 found = node_rays[beside].found;
        // Until then it is of another hit, maybe on a triangle that is no more.
        if (parameters.ray_level > level && found.y > 0.0) {
            is_hit = 1.0;
            self_hit = found.z;
            hit_distance = found.x / size;
            hit_position = position + hit_distance * direction;
            hit_normal = normal;
            vec3 where = node_rays[beside].direction;
            hit_triangle = vec3(where.z, node_rays[beside].reach, found.y);
            hit_barycentrics = vec3(1.0 - where.x - where.y, where.xy);
        }
    }
#endif
}
