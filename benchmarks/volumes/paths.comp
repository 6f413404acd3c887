// SPDX-License-Identifier: GPL-3.0-or-later
// Camera paths. MODE 0: first hits alone; 1: paths by free flight; 2: equiangular shadow rays; 3: these, and
// photons gathered in a ball at one point of the segment.
layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f, binding = 0) uniform image2D sums;
layout(rg32f, binding = 1) uniform writeonly image2D intervals;
layout(std430, binding = 0) readonly buffer Photons { Photon photons[]; };
layout(std430, binding = 2) readonly buffer Heads { int heads[]; };
layout(std430, binding = 3) readonly buffer Nexts { int nexts[]; };
uniform float radius, cell_size;

float path_radiance(vec3 from, vec3 along) {
    float result = 0.0, end;
    bool inside = false, specular = false, counts = false;
    for (int i = 0; i < 200; ++i) {
        int kind = surface_hit(from, along, end);
        vec2 interval = medium_interval(from, along);
        interval.y = min(interval.y, end);
        if (!inside && interval.y > interval.x) {
            float t = sample_distance(from, along, interval);
            if (t < FAR) {
                from += t * along;
                if (SINGLE == 1 || counts) result += ALBEDO * direct_light(from, along);
                if (random() >= ALBEDO) break;
                along = sample_phase(along);
                specular = false;
                counts = true;
                continue;
            }
        }
#if SCENE == 1
        if (kind == LAMP && specular && along.y > 0.0) result += RADIANCE;
        if (kind != GLASS) break;
        from += end * along;
        along = sample_glass(along, (from - BALL) / BALL_RADIUS * (inside ? -1.0 : 1.0), inside);
        specular = true;
#else
        break;
#endif
    }
    return result;
}

// Single scattering of light that no glass bends.
float single_scattering(vec3 along, vec2 interval) {
#if SCENE == 2
    float t = sample_distance(EYE, along, interval);
    return t < FAR ? ALBEDO * direct_light(EYE + t * along, along) : 0.0;
#else
    float nearest = dot(LAMP_CENTER - EYE, along), d = length(LAMP_CENTER - EYE - nearest * along);
    float a = atan(interval.x - nearest, d), b = atan(interval.y - nearest, d);
    float s = d * tan(mix(a, b, random()));
    float weight = (b - a) * (d * d + s * s) / d, t = clamp(nearest + s, interval.x, interval.y);
    return weight * ALBEDO * MAJORANT * exp(-MAJORANT * (t - interval.x)) * direct_light(EYE + t * along, along);
#endif
}

float gathered(vec3 along, vec2 interval) {
#if SCENE == 2
    float weight = 1.0, t = sample_distance(EYE, along, interval);
    if (t == FAR) return 0.0;
#else
    float weight = 1.0 - exp(-MAJORANT * (interval.y - interval.x));
    float t = interval.x - log(1.0 - random() * weight) / MAJORANT;
#endif
    vec3 point = EYE + t * along;
    ivec3 low = ivec3(floor((point + 1.5) / cell_size - 0.5));
    float sum = 0.0;
    for (int i = 0; i < 8; ++i) {
        ivec3 cell = low + ivec3(i & 1, (i >> 1) & 1, i >> 2);
        if (any(lessThan(cell, ivec3(0))) || any(greaterThanEqual(cell, ivec3(CELLS)))) continue;
        for (int k = heads[cell.x + CELLS * (cell.y + CELLS * cell.z)]; k >= 0; k = nexts[k]) {
            Photon photon = photons[k];
            vec3 to = photon.position_power.xyz - point;
            if (dot(to, to) < radius * radius)
                sum += photon.position_power.w * photon.direction_other.w * phase(-dot(photon.direction_other.xyz, along));
        }
    }
    return weight * sum / (4.0 / 3.0 * PI * radius * radius * radius);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= WIDTH || pixel.y >= HEIGHT) return;
    seed(uint(pixel.x + WIDTH * pixel.y));
    vec3 along = camera_ray(vec2(pixel) + 0.5 + jitter);
    float end;
    surface_hit(EYE, along, end);
    vec2 interval = medium_interval(EYE, along);
    interval.y = min(interval.y, end);
    float value = 0.0;
#if MODE == 1
    value = path_radiance(EYE, along);
#else
    if (interval.y > interval.x) {
#if MODE > 1 && SINGLE == 1
        value += single_scattering(along, interval);
#endif
#if MODE == 3
        value += gathered(along, interval);
#endif
    }
#endif
    imageStore(intervals, pixel, vec4(interval, 0.0, 0.0));
    imageStore(sums, pixel, imageLoad(sums, pixel) + vec4(vec3(value), 1.0));
}
