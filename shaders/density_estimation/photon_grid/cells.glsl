// SPDX-License-Identifier: GPL-3.0-or-later
// Cells of hashed grids. Their sides are at least twice the radius that is asked for, so that a sphere meets at most
// two cells along each axis, whose numbers differ in their lowest bits: these are the lowest bits of the bucket. So no
// bucket is visited twice, and it does not matter which cells share one.

ivec3 cell_of(vec3 position, float side) { return ivec3(floor(position / side)); }

// buckets: a power of two.
uint bucket_of(ivec3 cell, uint buckets) {
    uvec3 block = uvec3(cell >> 1), corner = uvec3(cell & 1);
    uint hash = block.x * 0x9E3779B1u ^ block.y * 0x85EBCA77u ^ block.z * 0xC2B2AE3Du;
    hash ^= hash >> 15;
    hash *= 0x2C1B3C6Du;
    hash ^= hash >> 12;
    return (hash << 3u | corner.z << 2u | corner.y << 1u | corner.x) & (buckets - 1u);
}
