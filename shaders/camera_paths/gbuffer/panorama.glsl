// SPDX-License-Identifier: GPL-3.0-or-later
// Where panoramas look, as Cycles lays them out: directions in the camera's axes (right, up, forward).
#include "camera_paths/gbuffer/camera_ray.glsl"

// A direction, and the solid angle that its surroundings cover over their area in the frame; 0: nothing is seen.
struct PanoramaPoint {
    vec3 direction;
    float solid_angle;
};

vec3 longitude_latitude(float longitude, float latitude) {
    return vec3(sin(longitude) * cos(latitude), sin(latitude), cos(longitude) * cos(latitude));
}

// Off the axis by an angle of this sine and cosine, toward a point of the frame.
vec3 off_axis(float sine, float cosine, vec2 toward) {
    float size = length(toward);
    return vec3(size > 0.0 ? sine * toward / size : vec2(0.0), cosine);
}

PanoramaPoint equirectangular(vec2 at) {
    vec4 range = camera.panorama_range;
    vec2 angles = mix(range.xz, range.yw, at), extent = range.yw - range.xz;
    return PanoramaPoint(longitude_latitude(angles.x, angles.y), abs(extent.x * extent.y * cos(angles.y)));
}

PanoramaPoint central_cylindrical(vec2 at) {
    vec4 range = camera.panorama_range;
    vec2 place = mix(range.xz, range.yw, at), extent = range.yw - range.xz;
    vec3 direction = normalize(vec3(sin(place.x), place.y, cos(place.x)));
    return PanoramaPoint(direction, abs(extent.x * extent.y) * pow(1.0 + place.y * place.y, -1.5));
}

PanoramaPoint equiangular_cubemap_face(vec2 at) {
    vec2 tangents = tan((at - 0.5) * (0.5 * PI)), stretch = 1.0 + tangents * tangents;
    float size = length(vec3(tangents, 1.0));
    return PanoramaPoint(vec3(tangents, 1.0) / size, 0.25 * PI * PI * stretch.x * stretch.y / (size * size * size));
}

// The frame holds the front of a ball of radius 1, seen from far off.
PanoramaPoint mirrorball(vec2 at) {
    vec2 across = 2.0 * at - 1.0;
    float size2 = dot(across, across), facing = sqrt(max(1.0 - size2, 0.0));
    return PanoramaPoint(vec3(2.0 * facing * across, 2.0 * facing * facing - 1.0), size2 > 1.0 ? 0.0 : 16.0);
}

PanoramaPoint fisheye_equidistant(vec2 at) {
    vec2 across = 2.0 * at - 1.0;
    float half_angle = 0.5 * camera.field_of_view, angle = length(across) * half_angle, least = max(angle, 1e-4);
    float solid_angle = 4.0 * half_angle * half_angle * abs(sin(least)) / least;
    return PanoramaPoint(off_axis(sin(angle), cos(angle), across), length(across) > 1.0 ? 0.0 : solid_angle);
}

PanoramaPoint fisheye_equisolid(vec2 at) {
    vec2 across = (at - 0.5) * camera.sensor;
    float half_sine = 0.5 * length(across) / camera.lens;
    bool is_inside = half_sine <= sin(0.25 * camera.field_of_view);
    float solid_angle = camera.sensor.x * camera.sensor.y / (camera.lens * camera.lens);
    // The fraction is the sine of half the angle.
    float sine = 2.0 * half_sine * sqrt(max(1.0 - half_sine * half_sine, 0.0));
    return PanoramaPoint(off_axis(sine, 1.0 - 2.0 * half_sine * half_sine, across), is_inside ? solid_angle : 0.0);
}

PanoramaPoint fisheye_lens_polynomial(vec2 at) {
    vec2 across = (at - 0.5) * camera.sensor;
    float size = length(across), least = max(size, 1e-3);
    vec4 powers = vec4(1.0, least, least * least, least * least * least), k = camera.polynomial;
    float angle = -(camera.polynomial_constant + dot(k, powers * size));
    float slope = dot(k * vec4(1.0, 2.0, 3.0, 4.0), powers);
    float solid_angle = camera.sensor.x * camera.sensor.y * abs(sin(dot(k, powers * least)) * slope) / least;
    return PanoramaPoint(off_axis(sin(angle), cos(angle), across),
                         abs(angle) > 0.5 * camera.field_of_view ? 0.0 : solid_angle);
}

PanoramaPoint panorama_point(vec2 at) {
    switch (camera.projection) {
    case PROJECTION_EQUIRECTANGULAR: return equirectangular(at);
    case PROJECTION_EQUIANGULAR_CUBEMAP_FACE: return equiangular_cubemap_face(at);
    case PROJECTION_MIRRORBALL: return mirrorball(at);
    case PROJECTION_FISHEYE_EQUIDISTANT: return fisheye_equidistant(at);
    case PROJECTION_FISHEYE_EQUISOLID: return fisheye_equisolid(at);
    case PROJECTION_FISHEYE_LENS_POLYNOMIAL: return fisheye_lens_polynomial(at);
    }
    return central_cylindrical(at);
}

// The lens faces each direction; what it calls its width points to the front of the camera, or of a mirror ball to
// its right, whose frame is also the other way round.
CameraRay panorama_ray(vec2 at, vec2 lens) {
    PanoramaPoint point = panorama_point(at);
    bool ball = camera.projection == PROJECTION_MIRRORBALL;
    vec3 front = ball ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 0.0, 1.0);
    vec3 across = front - dot(front, point.direction) * point.direction;
    across = dot(across, across) > 1e-12 ? normalize(across) : vec3(0.0, 1.0, 0.0);
    vec3 upward = cross(point.direction, across) * (ball ? 1.0 : -1.0);
    vec3 origin = across * lens.x + upward * lens.y;
    vec3 direction = lens == vec2(0.0) ? point.direction : normalize(camera.focus_distance * point.direction - origin);
    float reach = point.solid_angle > 0.0 ? camera.clip_end - camera.clip_start : 0.0;
    return CameraRay(origin + camera.clip_start * direction, direction, camera.clip_start, reach,
                     camera.pixel_area * point.solid_angle);
}
