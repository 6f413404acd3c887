// SPDX-License-Identifier: GPL-3.0-or-later
// What nodes may ask about the place that is shaded.

#include <ShadingInstance>
#include "common/bounce_counts.glsl"
#include "common/ray_kinds.glsl"
readonly buffer Triangles;
readonly buffer Attributes;
#include "common/triangle_normal.glsl"
readonly buffer ShadingInstances;
readonly buffer AttributeValues { uint attribute_values[]; };

const uint NO_INSTANCE = 0xffffffffu;

struct Surface {
    vec3 position;   // meters from the parameters' world_origin; of a world: the direction
    vec3 normal;     // shading normal, on the viewer's side
    vec3 geometric;  // geometric normal, on the viewer's side
    vec3 viewer;     // unit vector to where the path comes from
    vec2 uv;         // of the UV map in use
    vec3 barycentrics;
    vec3 beside;    // what surface_beside added to them
    uint triangle;  // NO_TRIANGLE: a world or a light
    uint instance;  // NO_INSTANCE: a world
    bool backfacing;
    uint ray;          // one or more of the bits of common/ray_kinds.glsl
    float ray_length;  // from the camera or the last event that was not straight through
    uint ray_depth;
    uint transparent_depth;
    uint bounce_counts;  // of the path, by type
    uint portal_depth;   // ray portals that the path has passed
};

void triangle_points(uint triangle, out vec3 v0, out vec3 v1, out vec3 v2) {
    v0 = triangle_vertices[3u * triangle].xyz;
    v1 = triangle_vertices[3u * triangle + 1u].xyz;
    v2 = triangle_vertices[3u * triangle + 2u].xyz;
}

// In Blender's world, which nodes show.
vec3 world_position(Surface surface) { return surface.position + parameters.world_origin; }

vec2 triangle_uv(uint triangle, vec3 b) {
    return b.x * attributes[triangle].uv0 + b.y * attributes[triangle].uv1 + b.z * attributes[triangle].uv2;
}

vec3 point_to_object(Surface surface, vec3 p) {
    if (surface.instance == NO_INSTANCE) return p;
    ShadingInstance at = shading_instances[surface.instance];
    return vec3(dot(at.to_object0, vec4(p, 1.0)), dot(at.to_object1, vec4(p, 1.0)), dot(at.to_object2, vec4(p, 1.0)));
}

vec3 direction_to_object(Surface surface, vec3 d) {
    if (surface.instance == NO_INSTANCE) return d;
    ShadingInstance at = shading_instances[surface.instance];
    return vec3(dot(at.to_object0.xyz, d), dot(at.to_object1.xyz, d), dot(at.to_object2.xyz, d));
}

// Normals and other vectors across the surface go by the transposed matrices.
vec3 normal_to_world(Surface surface, vec3 n) {
    if (surface.instance == NO_INSTANCE) return n;
    ShadingInstance at = shading_instances[surface.instance];
    return n.x * at.to_object0.xyz + n.y * at.to_object1.xyz + n.z * at.to_object2.xyz;
}

vec3 direction_to_world(Surface surface, vec3 d) {
    if (surface.instance == NO_INSTANCE) return d;
    ShadingInstance at = shading_instances[surface.instance];
    vec3 x = cross(at.to_object1.xyz, at.to_object2.xyz), y = cross(at.to_object2.xyz, at.to_object0.xyz),
         z = cross(at.to_object0.xyz, at.to_object1.xyz);
    return (d.x * x + d.y * y + d.z * z) / dot(at.to_object0.xyz, x);
}

vec3 normal_to_object(Surface surface, vec3 n) {
    if (surface.instance == NO_INSTANCE) return n;
    ShadingInstance at = shading_instances[surface.instance];
    vec3 x = cross(at.to_object1.xyz, at.to_object2.xyz), y = cross(at.to_object2.xyz, at.to_object0.xyz),
         z = cross(at.to_object0.xyz, at.to_object1.xyz);
    return vec3(dot(x, n), dot(y, n), dot(z, n)) / dot(at.to_object0.xyz, x);
}

// Volumes have others (materials/volume_attributes.glsl).
#ifndef VOLUME_ATTRIBUTES
// Where an attribute of an instance's mesh lies: a word of its place and one of its components; none: 0.
uvec2 attribute_place(Surface surface, uint layer) {
    if (surface.triangle == NO_TRIANGLE) return uvec2(0u);
    uint at = 2u * (surface.instance * parameters.attribute_count + layer);
    return uvec2(attribute_values[at], attribute_values[at + 1u]);
}

// An attribute at a corner of a triangle of the instance, absent components 0 and alpha 1.
vec4 attribute_corner(uvec2 place, uint local_triangle, uint corner) {
    uint at = place.x + (3u * local_triangle + corner) * place.y;
    vec4 value = vec4(0.0, 0.0, 0.0, 1.0);
    for (uint k = 0u; k < min(place.y, 4u); ++k) value[k] = uintBitsToFloat(attribute_values[at + k]);
    if (place.y == 1u) value.yz = value.xx;
    return value;
}

// An attribute within a triangle of the instance; 0 without the attribute.
vec4 attribute_within(uvec2 place, uint local_triangle, vec3 b) {
    if (place.y == 0u) return vec4(0.0);
    return b.x * attribute_corner(place, local_triangle, 0u) + b.y * attribute_corner(place, local_triangle, 1u)
           + b.z * attribute_corner(place, local_triangle, 2u);
}

vec4 attribute_value(Surface surface, uint layer) {
    uvec2 place = attribute_place(surface, layer);
    if (place.y == 0u) return vec4(0.0);
    return attribute_within(place, attributes[surface.triangle].mesh_triangle, surface.barycentrics);
}
#endif

// For tangents, which Cycles does not move along where a bump looks beside.
Surface surface_itself(Surface surface) {
    surface.barycentrics -= surface.beside;
    return surface;
}

// The same surface a little way off, as if its triangle went on: nothing but the place changes.
Surface surface_beside(Surface surface, vec3 way) {
    surface.position += way;
    if (surface.triangle == NO_TRIANGLE) return surface;
    vec3 v0, v1, v2;
    triangle_points(surface.triangle, v0, v1, v2);
    vec3 e1 = v1 - v0, e2 = v2 - v0, n = cross(e1, e2);
    float n2 = max(dot(n, n), 1e-30), b1 = dot(cross(way, e2), n) / n2, b2 = dot(cross(e1, way), n) / n2;
    vec3 beside = vec3(-b1 - b2, b1, b2);
    surface.barycentrics += beside;
    surface.beside += beside;
    surface.uv = triangle_uv(surface.triangle, surface.barycentrics);
    return surface;
}

// Generated coordinates of a mesh that nothing deforms; of a world, the direction.
vec3 within_texture_space(Surface surface) {
    if (surface.instance == NO_INSTANCE) return surface.position;
    ShadingInstance at = shading_instances[surface.instance];
    return (point_to_object(surface, surface.position) - at.texture_location) * at.texture_scale + 0.5;
}

// A tangent in object space, turned as Cycles turns it, and laid across the shading normal.
vec3 surface_tangent(Surface surface, vec3 in_object) {
    vec3 across = normal_to_world(surface, in_object);
    across -= dot(across, surface.normal) * surface.normal;
    float size = length(across);
    return size > 1e-20 ? across / size : vec3(0.0);
}

// Around the object's Z axis, where no tangent is given.
vec3 default_tangent(Surface surface) {
    vec3 at = within_texture_space(surface) - 0.5;
    return surface_tangent(surface, vec3(-at.y, at.x, 0.0));
}
