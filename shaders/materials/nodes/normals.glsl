// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes that turn the shading normal.

#include "materials/nodes/geometry.glsl"
#include <NormalSpaces>

// The front's normal in object space, interpolated between unit normals of the corners, or the triangle's where that
// is flat.
vec3 object_normal(Surface surface) {
    vec3 n = vec3(0.0);
    for (int corner = 0; corner < 3; ++corner) {
        vec3 b = vec3(corner == 0, corner == 1, corner == 2);
        n += surface.barycentrics[corner] * normalize(normal_to_object(surface, triangle_normal(surface.triangle, b)));
    }
    return n;
}

void node_normal_map(Surface surface, int space, uint layer, float strength, vec3 color, out vec3 normal) {
    vec3 mapped = 2.0 * color - 1.0;
    surface = surface_itself(surface);
    vec3 n;
    if (space == NORMAL_MAP_TANGENT) {
        uvec2 place = attribute_place(surface, layer);
        if (place.y < 4u) {
            normal = surface.normal;
            return;
        }
        // In object space, tangent and normal interpolated without being made unit.
        vec4 tangent = attribute_value(surface, layer);
        vec3 front = object_normal(surface);
        mapped.xy *= strength;
        mapped.z = mix(1.0, mapped.z, clamp(strength, 0.0, 1.0));
        n = normal_to_world(surface, mapped.x * tangent.xyz + mapped.y * tangent.w * cross(front, tangent.xyz)
                                         + mapped.z * front);
    } else {
        // The Blender spaces are those of its former renderer: Y and Z are turned round.
        if (space >= NORMAL_MAP_BLENDER_OBJECT) mapped.yz = -mapped.yz;
        bool of_object = space == NORMAL_MAP_OBJECT || space == NORMAL_MAP_BLENDER_OBJECT;
        n = of_object ? normal_to_world(surface, mapped) : mapped;
        vec3 front = surface.backfacing ? -surface.normal : surface.normal;
        float size = length(n);
        n = size > 1e-20 ? n / size : front;
        if (strength != 1.0) n = front + (n - front) * max(strength, 0.0);
    }
    float size = length(n);
    n = size > 1e-20 ? n / size : surface.normal;
    normal = surface.backfacing && size > 1e-20 ? -n : n;
}

// Two ways across the surface, so many times as long as what a pixel sees of it.
void bump_offsets(Surface surface, float filter_width, out vec3 along_x, out vec3 along_y) {
    differential_frame(surface.geometric, along_x, along_y);
    float extent = max(abs(surface.position.x), max(abs(surface.position.y), abs(surface.position.z)));
    float width = max(filter_width * pixel_width(surface), 1e-4 * max(surface.ray_length, 0.01 * extent));
    if (surface.backfacing) width = -width;  // seen from behind, Cycles looks the other way
    along_x *= width;
    along_y *= width;
}

// The gradient of the height across the surface (Mikkelsen 2010, Bump Mapping Unparametrized Surfaces on the GPU).
void node_bump(Surface surface, int invert, float strength, float distance, vec3 normal_in, vec3 along_x, vec3 along_y,
               float height_x, float height_y, out vec3 normal) {
    vec3 across_x = cross(along_y, normal_in), across_y = cross(normal_in, along_x);
    float determinant = dot(along_x, across_x);
    vec3 gradient = height_x * across_x + height_y * across_y;
    float scale = (invert != 0) != surface.backfacing ? -distance : distance;
    vec3 bumped = abs(determinant) * normal_in - scale * sign(determinant) * gradient;
    float size = length(bumped);
    bumped = size > 1e-30 ? bumped / size : normal_in;
    normal = normalize(mix(normal_in, bumped, max(strength, 0.0)));
}

// How far the surface is pushed out, in world space.
void node_displacement(Surface surface, int space, float height, float midlevel, float scale, vec3 normal_in,
                       out vec3 displacement) {
    float amount = (height - midlevel) * scale;
    if (space == DISPLACEMENT_OBJECT) {
        vec3 n = normal_to_object(surface, normal_in);
        displacement = direction_to_world(surface, n / max(length(n), 1e-20) * amount);
    } else displacement = normal_in * amount;
}

void node_vector_displacement(Surface surface, int space, uint layer, vec3 vector, float midlevel, float scale,
                              out vec3 displacement) {
    displacement = (vector - midlevel) * scale;
    if (space == VECTOR_DISPLACEMENT_TANGENT) {
        vec3 n = normalize(normal_to_object(surface, surface.normal));
        vec4 tangent = attribute_value(surface_itself(surface), layer);
        vec3 across = cross(n, tangent.xyz);
        float size = length(across);
        across *= size > 1e-20 ? tangent.w / size : 0.0;
        displacement = displacement.x * tangent.xyz + displacement.y * n + displacement.z * across;
    }
    if (space != VECTOR_DISPLACEMENT_WORLD) displacement = direction_to_world(surface, displacement);
}

void node_displacement_height(Surface surface, vec3 displacement, out float height) {
    height = dot(displacement, surface.normal);
}
