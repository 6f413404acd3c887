// SPDX-License-Identifier: GPL-3.0-or-later
// A surface as it was before its vertices were moved, for the bump of what moves them.

#include "materials/nodes/geometry.glsl"

// Where a way across the surface led there, object space; layer: of the positions before.
vec3 undisplaced_way(Surface surface, vec3 way, uint layer) {
    if (attribute_place(surface, layer).y < 3u) return direction_to_object(surface, way);
    return (attribute_value(surface_beside(surface, way), layer) - attribute_value(surface, layer)).xyz;
}

// How much longer ways were there than one now, in the mean.
float undisplaced_stretch(Surface surface, vec3 now, vec3 way_x, vec3 way_y) {
    return 0.5 * (length(direction_to_world(surface, way_x)) + length(direction_to_world(surface, way_y)))
           / max(length(now), 1e-30);
}

// The surface a little way off. Attributes are those of that place of the mesh; the position is where Cycles has it: as
// far from where the surface was as it was there, but along the surface as it lies now.
Surface undisplaced_beside(Surface surface, vec3 way, float stretch, uint layer) {
    Surface there = surface_beside(surface, way);
    if (attribute_place(surface, layer).y < 3u) return there;
    ShadingInstance at = shading_instances[surface.instance];
    vec3 origin = vec3(at.to_object0.w, at.to_object1.w, at.to_object2.w);
    there.position = direction_to_world(surface, attribute_value(surface, layer).xyz - origin) + stretch * way;
    return there;
}

// That of the mesh, which is the one before, however it lies to triangle and viewer now; layer: of those that flat
// faces share at their vertices, where there are any.
vec3 undisplaced_normal(Surface surface, uint layer) {
    vec3 n = attribute_place(surface, layer).y < 3u ? triangle_normal(surface.triangle, surface.barycentrics)
                                                    : normal_to_world(surface, attribute_value(surface, layer).xyz);
    float size = length(n);
    return size > 1e-6 ? (surface.backfacing ? -n : n) / size : surface.normal;
}

vec3 unit_to_object(Surface surface, vec3 n) {
    n = normal_to_object(surface, n);
    return n / max(length(n), 1e-20);
}

vec3 unit_to_world(Surface surface, vec3 n) {
    n = normal_to_world(surface, n);
    return n / max(length(n), 1e-20);
}
