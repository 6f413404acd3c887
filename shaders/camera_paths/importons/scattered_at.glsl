// SPDX-License-Identifier: GPL-3.0-or-later
// Where a ray was scattered, from where shadow rays look for what it meets: straight through surfaces that stop none of
// them it begins anew behind each. The includer declares before the block GatheringVertices.

#include "common/iteration.glsl"
vec3 scattered_at(uint index, CameraPath path, Ray ray) {
    if ((path.flags & PATH_SEEN_THROUGH) == 0u) return ray.origin;
    // A path that gathers a third time does so within iteration.gathers_again_below of its second vertex.
    return (path.flags & PATH_GATHERED_AGAIN) != 0u ? gathering_vertices[index].hit
                                                    : gathering_vertices[index].position;
}
