// SPDX-License-Identifier: GPL-3.0-or-later
// The radii in which photons count where camera paths come to. The includer declares before the member
// segment of its parameters, and the buffers Camera and RadiusFactors.

#include "common/iteration.glsl"
#include "camera_paths/gbuffer/projections.glsl"
#include "common/disk_radius.glsl"

// The radius in which photons count at the path's new vertex.
float vertex_radius(inout CameraPath path, vec3 direction, Closure closure) {
    path.total_length += closure.distance;
    bool parallel = camera.projection == PROJECTION_ORTHOGRAPHIC;
    if (parameters.segment == 0u) {
        // Eq. 3: radius of the disk that a pixel's footprint covers, times the scale.
        float facing = max(abs(dot(unpack_unit_vector(closure.geometric_normal), direction)), 1e-4);
        path.primary_radius *= iteration.radius_scale / sqrt(facing);
    }
    // Eq. 4, with the limits that shrink as the radius does. Parallel rays stay as far apart as they are.
    float radius = path.primary_radius * (parallel ? 1.0 : path.total_length);
    return iteration.shrinkage * clamp(radius, iteration.radius_minimum, iteration.radius_maximum);
}

// Of photons that only specular surfaces have scattered, if any; index: in the band.
float caustic_radius_of(uint index, float radius, bool gathered) {
    float factor = iteration.number <= 1u ? iteration.most_radius_factor : radius_factors[index];
    return gathered ? max(radius, iteration.final_gather_radius) : factor * radius;
}
