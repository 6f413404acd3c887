// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes that trace rays. Worlds and lights have no surface to trace them from.

vec3 direction_or(vec3 direction, vec3 other) {
    float length2 = dot(direction, direction);
    return length2 > 1e-20 ? direction * inversesqrt(length2) : other;
}

#ifdef NODE_RAYS
uint ray_count(float samples) { return uint(clamp(samples, 1.0, float(MAX_NODE_RAYS))); }
#endif

// The fraction of the rays around the normal that come as far as the distance.
void node_ambient_occlusion(Surface surface, int inside, int only_local, uint place, uint level, vec3 color_in,
                            float reach, vec3 normal, float samples, out vec3 color, out float ao) {
    ao = 1.0;
#ifdef NODE_RAYS
    if (parameters.ray_stride > 0u && reach > 0.0) {
        vec3 direction = direction_or(normal, surface.normal);
        uint count = ray_count(samples);
        uint kind = only_local != 0 ? QUERY_LOCAL_OCCLUSION : QUERY_OCCLUSION;
        ao = found_by_rays(place, level, kind, count, inside != 0 ? -direction : direction, reach).x / float(count);
    }
#endif
    color = ao * color_in;
}

// The mean normal of what of the object lies within the radius. As in Cycles, blurred reflections see none of it.
void node_bevel(Surface surface, uint place, uint level, float radius, vec3 normal_in, float samples, out vec3 normal) {
    normal = normal_in;
#ifdef NODE_RAYS
    bool blurred = (surface.ray & RAY_DIFFUSE) != 0u;
    if (parameters.ray_stride > 0u && radius > 0.0 && !blurred) {
        uint count = ray_count(samples);
        vec3 mean_normal = found_by_rays(place, level, QUERY_BEVEL, count, surface.geometric, radius);
        vec3 beveled = direction_or(surface.backfacing ? -mean_normal : mean_normal, surface.normal);
        normal = direction_or(normal_in + beveled - surface.normal, normal_in);
    }
#endif
}
