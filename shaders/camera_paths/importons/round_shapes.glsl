// SPDX-License-Identifier: GPL-3.0-or-later
// Strands and points are too small for disks of photons. The includer has lights/light_tree.glsl and the parameter
// has_round_shapes.

// The length of the ray to a closure by which path_gathers decides.
#include "common/iteration.glsl"
float length_to_gather_by(Closure closure) {
    bool is_round = iteration.has_round_shapes != 0u && is_one_sided(triangle_vertices[3u * closure.triangle].w);
    return is_round ? LENGTH_ON_ROUND_SHAPES : closure.distance;
}
