// SPDX-License-Identifier: GPL-3.0-or-later
// How the camera of a band projects points for rasterization; the block Camera has to be there.

// right, up and forward of a point, meters from the camera
vec3 camera_space(vec3 point) {
    vec3 offset = point - camera.position;
    return vec3(dot(offset, camera.right), dot(offset, camera.up), dot(offset, camera.forward));
}

vec4 clip_position(vec3 p) {
    vec2 middle = camera.window.xz + camera.window.yw, extent = camera.window.yw - camera.window.xz;
    float near = camera.clip_start, far = camera.clip_end;
    if (camera.projection == PROJECTION_ORTHOGRAPHIC)
        return vec4((2.0 * p.xy - middle) / extent, (2.0 * p.z - near - far) / (far - near), 1.0);
    return vec4((2.0 * p.xy - middle * p.z) / extent, ((far + near) * p.z - 2.0 * far * near) / (far - near), p.z);
}

// Logarithmic in perspective: the same relative resolution near and far.
float fragment_depth(float view_depth) {
    return camera.projection == PROJECTION_ORTHOGRAPHIC
               ? (view_depth - camera.clip_start) / (camera.clip_end - camera.clip_start)
               : log(view_depth / camera.clip_start) / log(camera.clip_end / camera.clip_start);
}
