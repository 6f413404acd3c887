// SPDX-License-Identifier: GPL-3.0-or-later
// The place in the frame where a panorama shows a direction (right, up, forward), as fractions of the frame's width and
// height: the inverse of camera_paths/gbuffer/panorama.glsl. The place may lie outside the frame. The includer declares
// the storage block of the camera.
#include "common/constants.glsl"
#include "camera_paths/gbuffer/projections.glsl"

const int NEWTON_STEPS = 12;

vec2 unit_or_none(vec2 toward) {
    float size = length(toward);
    return size > 0.0 ? toward / size : vec2(0.0);
}

// Millimeters from the middle at which a polynomial lens shows this angle off its axis: by Newton's method, as Cycles.
float lens_polynomial_distance(float angle) {
    vec4 k = camera.polynomial;
    float size = (-angle - camera.polynomial_constant) / (k.x != 0.0 ? k.x : 1.0);
    for (int step = 0; step < NEWTON_STEPS; ++step) {
        vec4 powers = vec4(1.0, size, size * size, size * size * size);
        float value = camera.polynomial_constant + dot(k, powers * size) + angle;
        float slope = dot(k * vec4(1.0, 2.0, 3.0, 4.0), powers);
        if (slope == 0.0) break;
        size -= value / slope;
    }
    return size;
}

vec2 panorama_place(vec3 direction) {
    vec4 range = camera.panorama_range;
    float off_axis = acos(clamp(direction.z, -1.0, 1.0));
    vec2 toward = unit_or_none(direction.xy);
    switch (camera.projection) {
    case PROJECTION_EQUIRECTANGULAR: {
        vec2 angles = vec2(atan(direction.x, direction.z), asin(clamp(direction.y, -1.0, 1.0)));
        return (angles - range.xz) / (range.yw - range.xz);
    }
    case PROJECTION_EQUIANGULAR_CUBEMAP_FACE:
        return 0.5 + vec2(atan(direction.x, direction.z), atan(direction.y, direction.z)) * (2.0 / PI);
    case PROJECTION_MIRRORBALL: return 0.5 + 0.5 * normalize(direction + vec3(0.0, 0.0, 1.0)).xy;
    case PROJECTION_FISHEYE_EQUIDISTANT: return 0.5 + toward * (off_axis / camera.field_of_view);
    case PROJECTION_FISHEYE_EQUISOLID: return 0.5 + toward * (2.0 * camera.lens * sin(0.5 * off_axis)) / camera.sensor;
    case PROJECTION_FISHEYE_LENS_POLYNOMIAL: return 0.5 + toward * lens_polynomial_distance(off_axis) / camera.sensor;
    }
    vec2 place = vec2(atan(direction.x, direction.z), direction.y / length(direction.xz));
    return (place - range.xz) / (range.yw - range.xz);
}

// Of the frame's width, how far apart the same direction is shown again; 0: nowhere.
float panorama_period() {
    bool around =
        camera.projection == PROJECTION_EQUIRECTANGULAR || camera.projection == PROJECTION_CENTRAL_CYLINDRICAL;
    return around ? 2.0 * PI / (camera.panorama_range.y - camera.panorama_range.x) : 0.0;
}
