// SPDX-License-Identifier: GPL-3.0-or-later
// The radii in which photons count at the vertices of camera paths. The includer declares before the member segment of
// its parameters, and the block RadiusFactors.

#include "common/iteration.glsl"
#include "common/disk_radius.glsl"
#include "camera_paths/importons/final_gather.glsl"

// Radii of photons at a vertex, meters. Photons that know their footprint count within minimum to maximum.
struct PhotonRadii {
    float footprint;  // of the pixel, Eq. 4
    float minimum;
    float maximum;
};

// The radius of Eq. 4 at the path's new vertex.
float footprint_radius(inout CameraPath path, vec3 direction, Closure closure) {
    path.total_length += closure.distance;
    if (parameters.segment == 0u) {
        // Eq. 3: the radius of the disk that a pixel's footprint covers, times the scale.
        float facing = max(abs(dot(unpack_unit_vector(closure.geometric_normal), direction)), 1e-4);
        path.primary_radius *= iteration.radius_scale / sqrt(facing);
    }
    // Eq. 4, with limits that shrink as the radius does. Parallel rays stay as far apart as they are.
    float radius = path.primary_radius * (iteration.orthographic_camera != 0u ? 1.0 : path.total_length);
    return iteration.shrinkage * clamp(radius, iteration.radius_minimum, iteration.radius_maximum);
}

// index: of the path in its band.
PhotonRadii photon_radii(uint index, inout CameraPath path, vec3 direction, Closure closure) {
    float footprint = footprint_radius(path, direction, closure);
    if (is_final_gather(path)) {
        float radius = max(footprint, iteration.final_gather_radius);
        return PhotonRadii(footprint, radius, radius);
    }
    // Caustics of photons that only specular surfaces have scattered are estimated within a radius of the pixel's own.
    float factor = iteration.number <= 1u ? iteration.maximum_radius_factor : radius_factors[index];
    return PhotonRadii(footprint, footprint, factor * footprint);
}
