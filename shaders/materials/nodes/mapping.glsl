// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/nodes/safe.glsl"
#include <MappingOptions>

// Rotation about x, then y, then z (Blender's Euler XYZ), angles in radians.
mat3 euler_rotation(vec3 angles) {
    vec3 c = cos(angles), s = sin(angles);
    return mat3(c.y * c.z, c.y * s.z, -s.y, s.x * s.y * c.z - c.x * s.z, s.x * s.y * s.z + c.x * c.z, s.x * c.y,
                c.x * s.y * c.z + s.x * s.z, c.x * s.y * s.z - s.x * c.z, c.x * c.y);
}

// About a unit axis (Rodrigues).
vec3 rotate_about(vec3 v, vec3 axis, float angle) {
    float c = cos(angle);
    return c * v + sin(angle) * cross(axis, v) + (1.0 - c) * dot(axis, v) * axis;
}

void node_mapping(int vector_type, vec3 vector, vec3 location, vec3 rotation, vec3 scale, out vec3 result) {
    mat3 turn = euler_rotation(rotation);
    switch (vector_type) {
    case MAPPING_POINT: result = turn * (vector * scale) + location; break;
    case MAPPING_TEXTURE: result = safe_divide((vector - location) * turn, scale); break;  // the inverse
    case MAPPING_VECTOR: result = turn * (vector * scale); break;
    default: result = safe_normalize(turn * safe_divide(vector, scale)); break;  // MAPPING_NORMAL
    }
}

void node_vector_rotate(int rotation_type, int invert, vec3 vector, vec3 center, vec3 axis, float angle, vec3 rotation,
                        out vec3 result) {
    vec3 from_center = vector - center;
    if (rotation_type == ROTATE_EULER_XYZ) {
        mat3 turn = euler_rotation(rotation);
        result = (invert != 0 ? from_center * turn : turn * from_center) + center;
        return;
    }
    switch (rotation_type) {
    case ROTATE_AXIS_ANGLE: axis = safe_normalize(axis); break;
    case ROTATE_X_AXIS: axis = vec3(1.0, 0.0, 0.0); break;
    case ROTATE_Y_AXIS: axis = vec3(0.0, 1.0, 0.0); break;
    default: axis = vec3(0.0, 0.0, 1.0); break;  // ROTATE_Z_AXIS
    }
    result = axis == vec3(0.0) ? vector : rotate_about(from_center, axis, invert != 0 ? -angle : angle) + center;
}
