// SPDX-License-Identifier: GPL-3.0-or-later
// Points, vectors and normals from one space to another. The node's camera space has Z forward.
#include "materials/nodes/safe.glsl"

#include <VectorTransforms>

vec3 object_to_world(Surface surface, int vector_type, vec3 v) {
    if (vector_type == TRANSFORM_POINT)
        return direction_to_world(surface, v - point_to_object(surface, vec3(0.0))) + parameters.world_origin;
    return vector_type == TRANSFORM_VECTOR ? direction_to_world(surface, v) : normal_to_world(surface, v);
}

vec3 world_to_object(Surface surface, int vector_type, vec3 v) {
    if (vector_type == TRANSFORM_POINT) return point_to_object(surface, v - parameters.world_origin);
    return vector_type == TRANSFORM_VECTOR ? direction_to_object(surface, v) : normal_to_object(surface, v);
}

// Cameras are not scaled: the transposed rotation is the inverse.
vec3 camera_to_world(int vector_type, vec3 v) {
    v.z = -v.z;
    if (vector_type != TRANSFORM_POINT) return v * mat3(parameters.world_to_camera);
    return (v - parameters.world_to_camera[3].xyz) * mat3(parameters.world_to_camera) + parameters.world_origin;
}

vec3 world_to_camera(int vector_type, vec3 v) {
    if (vector_type == TRANSFORM_POINT) v -= parameters.world_origin;
    v = (parameters.world_to_camera * vec4(v, vector_type == TRANSFORM_POINT ? 1.0 : 0.0)).xyz;
    return vec3(v.xy, -v.z);
}

void node_vector_transform(Surface surface, int vector_type, int convert_from, int convert_to, vec3 vector,
                           out vec3 result) {
    result = vector;
    if (convert_from == convert_to) return;
    if (convert_from != SPACE_WORLD)
        result = convert_from == SPACE_OBJECT ? object_to_world(surface, vector_type, result)
                                              : camera_to_world(vector_type, result);
    if (convert_to != SPACE_WORLD)
        result = convert_to == SPACE_OBJECT ? world_to_object(surface, vector_type, result)
                                            : world_to_camera(vector_type, result);
    if (vector_type > TRANSFORM_VECTOR) result = safe_normalize(result);
}
