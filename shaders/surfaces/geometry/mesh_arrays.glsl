// SPDX-License-Identifier: GPL-3.0-or-later
// The arrays of all meshes, where those of each instance begin, and the triangles that are made of them.
#include <InstanceEntry>

readonly buffer Instances;
readonly buffer Positions { float positions[]; };
readonly buffer CornerVertices;
readonly buffer TriangleCorners;
writeonly buffer Triangles;

vec3 three_floats(uint index) {
    return vec3(positions[3u * index], positions[3u * index + 1u], positions[3u * index + 2u]);
}

// By the bits, which no compiler may assume to be those of a number.
bool reasonable(vec3 p) { return all(lessThan(floatBitsToUint(p) & 0x7fffffffu, uvec3(floatBitsToUint(1e15)))); }

// The last of some instances whose first triangle is not behind a triangle.
uint instance_of(uint triangle, uint instance_count) {
    uint low = 0u, high = instance_count - 1u;
    while (low < high) {
        uint middle = (low + high + 1u) / 2u;
        if (instances[middle].first_triangle <= triangle) low = middle;
        else high = middle - 1u;
    }
    return low;
}
