// SPDX-License-Identifier: GPL-3.0-or-later
// Faces of the splat cubemap: 2 axis + (1 when negative), in a 3 x 2 atlas.

vec3 to_face(vec3 p, int face) {
    vec3 q = face < 2 ? p.yzx : (face < 4 ? p.zxy : p);
    if ((face & 1) != 0) q.z = -q.z;
    return q;
}

// Behind the heads of the lists lie flags of occupied blocks of cells, and behind those, for each face, the bounds of
// its occupied cells: size - x, size - y, x + 1, y + 1 at their greatest, so that zeros mean none.
#include <SplatCubemap>

int first_block(int size) { return 6 * size * size; }
int block_index(int face, ivec2 block, int size) {
    return first_block(size) + (face * (size / BLOCK_SIZE) + block.y) * (size / BLOCK_SIZE) + block.x;
}
int face_bounds(int face, int size) {
    return first_block(size) + 6 * (size / BLOCK_SIZE) * (size / BLOCK_SIZE) + 4 * face;
}

int face_of(vec3 p) {
    vec3 a = abs(p);
    if (a.x >= a.y && a.x >= a.z) return p.x < 0.0 ? 1 : 0;
    if (a.y >= a.z) return p.y < 0.0 ? 3 : 2;
    return p.z < 0.0 ? 5 : 4;
}
