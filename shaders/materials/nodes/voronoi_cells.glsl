// SPDX-License-Identifier: GPL-3.0-or-later
// Points and colors of the cells of Voronoi textures (Worley, A Cellular Texture Basis Function, 1996).
// Coordinates are of one to four dimensions, a literal; the components past them are zero.
#include "materials/nodes/hash.glsl"

#include <VoronoiMetrics>
const float VORONOI_FAR = 3.4028234e38;

// Jarzynski and Olano, Hash Functions for GPU Rendering (JCGT 2020): pcg2d, pcg3d, pcg4d, on signed numbers
// (the shift keeps the sign) as Cycles has them. One function: what a dimension does not use falls away.
vec4 voronoi_hash(int dimensions, ivec4 v) {
    v = v * 1664525 + 1013904223;
    for (int turn = 0; turn < 2; ++turn) {
        if (turn == 1) v ^= v >> 16;
        if (dimensions == 2) {
            v.x += v.y * 1664525;
            v.y += v.x * 1664525;
        } else {
            v.x += v.y * (dimensions == 3 ? v.z : v.w);
            v.y += v.z * v.x;
            v.z += v.x * v.y;
            if (dimensions == 4) v.w += v.y * v.z;
        }
    }
    return vec4(v & 0x7fffffff) / 2147483648.0;
}

// 1 in the dimensions that there are, 0 in the others.
vec4 voronoi_axes(int dimensions) { return vec4(1.0, dimensions > 1, dimensions > 2, dimensions > 3); }

// Of a cell in one dimension; never -0.0, which compilers make of rounded coordinates and which hashes to elsewhere.
float voronoi_key(ivec4 cell) { return cell.x == 0 ? 0.0 : float(cell.x); }

// A cell's point within the cell, in the unit cube.
vec4 voronoi_point(int dimensions, ivec4 cell) {
    if (dimensions == 1) return vec4(hash_to_unit(voronoi_key(cell)), 0.0, 0.0, 0.0);
    return voronoi_hash(dimensions, cell) * voronoi_axes(dimensions);
}

vec3 voronoi_color(int dimensions, ivec4 cell) {
    if (dimensions == 1) return hash_to_color(voronoi_key(cell));
    if (dimensions == 2) return voronoi_hash(3, ivec4(cell.xy, 0, 0)).xyz;
    return voronoi_hash(dimensions, cell).xyz;
}

// Grows with the distance and costs less: distances are voronoi_root of it.
float voronoi_rank(int dimensions, int metric, float exponent, vec4 way) {
    way = abs(way);
    if (dimensions == 1) return way.x;
    if (metric == VORONOI_EUCLIDEAN) return dot(way, way);
    if (metric == VORONOI_CHEBYCHEV) return max(max(way.x, way.y), max(way.z, way.w));
    if (metric == VORONOI_MINKOWSKI) way = pow(way, vec4(exponent)) * voronoi_axes(dimensions);
    return way.x + way.y + way.z + way.w;
}

float voronoi_root(int dimensions, int metric, float exponent, float rank) {
    if (dimensions > 1 && metric == VORONOI_EUCLIDEAN) return sqrt(rank);
    if (dimensions > 1 && metric == VORONOI_MINKOWSKI) return rank > 0.0 ? pow(rank, 1.0 / exponent) : 0.0;
    return rank;
}

// Cells of a neighborhood 3 or 5 wide.
int voronoi_cells(int dimensions, int width) {
    int square = width * width;
    return dimensions == 1 ? width : dimensions == 2 ? square : dimensions == 3 ? square * width : square * square;
}

// The cells' places in order, x runs fastest.
ivec4 voronoi_offset(int dimensions, int width, int index) {
    uint i = uint(index), side = uint(width);
    ivec4 place = ivec4(i % side, i / side % side, i / (side * side) % side, i / (side * side * side));
    return (place - width / 2) * ivec4(voronoi_axes(dimensions));
}
