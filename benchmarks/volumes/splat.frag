// SPDX-License-Identifier: GPL-3.0-or-later
// Radiance that a photon or a beam adds to a pixel's ray.
uniform float radius;
layout(binding = 1) uniform sampler2D intervals; // of the rays in the medium, up to what they hit
#if SCENE == 2
layout(binding = 2) uniform sampler3D transmittances; // of camera rays, by distance from the cloud's front
#endif
flat in vec4 begin_power;
flat in vec4 direction_other;
out vec4 color;

float camera_transmittance(vec2 interval, float t) {
#if SCENE == 2
    vec3 place = vec3(gl_FragCoord.xy / vec2(WIDTH, HEIGHT), 0.5 / SLICES + (t - 2.6) / 2.0 * (1.0 - 1.0 / SLICES));
    return textureLod(transmittances, place, 0.0).r;
#else
    return exp(-MAJORANT * (t - interval.x));
#endif
}

void main() {
    vec2 interval = texelFetch(intervals, ivec2(gl_FragCoord.xy), 0).xy;
    vec3 from = begin_power.xyz - EYE, direction = direction_other.xyz, along;
    float value = 0.0, t;
#if SPLAT == 0
    t = length(from);
    along = from / t;
    float end;
    surface_hit(EYE, along, end); // at the photon's own ray
    float solid_angle = 4.0 * TANGENT * TANGENT / float(HEIGHT * HEIGHT) * pow(-along.z, 3.0);
    interval = medium_interval(EYE, along);
    if (t < end) value = 1.0 / (t * t * solid_angle);
#elif SPLAT == 1
    along = camera_ray(gl_FragCoord.xy + jitter);
    t = dot(from, along);
    if (dot(from, from) - t * t < radius * radius) value = 1.0 / (PI * radius * radius);
#else
    along = camera_ray(gl_FragCoord.xy + jitter);
    vec3 normal = cross(along, direction);
    float squared = dot(normal, normal), miss = dot(from, normal);
    t = dot(cross(from, direction), normal) / squared;
    float s = dot(cross(from, along), normal) / squared;
    if (miss * miss < radius * radius * squared && s >= 0.0 && s < direction_other.w) {
        value = ALBEDO * extinction(EYE + t * along) / (2.0 * radius * sqrt(squared));
        if (BEAMS == 2) value *= exp(-MAJORANT * s);
    }
#endif
    if (t < interval.x || t > interval.y) value = 0.0;
    if (value > 0.0)
        value *= begin_power.w * phase(-dot(direction, along)) * camera_transmittance(interval, t);
    color = vec4(vec3(value), 0.0);
}
