// SPDX-License-Identifier: GPL-3.0-or-later
// Cameras whose parents shear them: axes that are not at right angles. The block Camera has to be there.
#include "camera_paths/gbuffer/projections.glsl"

const float SHEARED = 1e-4;  // as scene/camera.py has it

bool camera_is_sheared() {
    vec3 x = camera.right, y = camera.up, z = camera.forward;
    return any(greaterThan(abs(vec3(dot(x, y), dot(y, z), dot(z, x))), vec3(SHEARED)));
}

// Across the plane of right and up, so long that along forward depths are distances.
vec3 camera_normal() {
    vec3 normal = cross(camera.right, camera.up);
    return normal / dot(normal, camera.forward);
}
