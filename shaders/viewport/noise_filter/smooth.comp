#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// One round of the edge-avoiding a-trous wavelet transform (Dammertz et al., HPG 2010), its steps by the variance
// (Schied et al. 2017).

layout(local_size_x = 64) in;

#include <NoiseFilterParameters>
#include "common/invocation.glsl"
#include "common/luminance.glsl"
uniform Parameters { NoiseFilterParameters parameters; };
uniform sampler2D signal_image;
uniform sampler2D guide_image;
writeonly buffer Signals;

const float KERNEL[2] = float[](0.5, 0.25);
const float DEPTH_STEP = 0.01;
const float NORMAL_POWER = 64.0;

float along(float before, float here, float after) {
    float back = here - before, on = after - here;
    return abs(back) < abs(on) ? back : on;
}

// How depth changes from pixel to pixel, by the flatter side of each axis.
vec2 depth_slope(ivec2 pixel, ivec2 last, float here) {
    ivec2 low = max(pixel - 1, ivec2(0)), high = min(pixel + 1, last);
    return vec2(along(texelFetch(guide_image, ivec2(low.x, pixel.y), 0).w, here,
                      texelFetch(guide_image, ivec2(high.x, pixel.y), 0).w),
                along(texelFetch(guide_image, ivec2(pixel.x, low.y), 0).w, here,
                      texelFetch(guide_image, ivec2(pixel.x, high.y), 0).w));
}

// The variance is noisy itself: that of the pixels next to it counts as well.
float steady_variance(ivec2 pixel, ivec2 last) {
    float sum = 0.0;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x)
            sum += texelFetch(signal_image, clamp(pixel + ivec2(x, y), ivec2(0), last), 0).w
                   / float((1 << abs(x)) * (1 << abs(y)) * 4);
    return sum;
}

vec4 smoothed(ivec2 pixel, ivec2 last) {
    vec4 signal = texelFetch(signal_image, pixel, 0), guide = texelFetch(guide_image, pixel, 0);
    float bright = luminance(signal.rgb);
    float edge = parameters.luminance_step * sqrt(steady_variance(pixel, last)) + 1e-4 * abs(bright);
    vec2 slope = depth_slope(pixel, last, guide.w);
    bool surface = guide.xyz != vec3(0.0);
    vec4 sum = vec4(0.0);
    float total = 0.0;
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            ivec2 offset = int(parameters.step) * ivec2(x, y), other = pixel + offset;
            if (any(lessThan(other, ivec2(0))) || any(greaterThan(other, last))) continue;
            vec4 around = texelFetch(guide_image, other, 0), value = texelFetch(signal_image, other, 0);
            float weight = KERNEL[abs(x)] * KERNEL[abs(y)];
            if (x != 0 || y != 0) {
                float expected = dot(slope, vec2(offset));
                float off = abs(around.w - guide.w - expected) / (abs(expected) + DEPTH_STEP * guide.w + 1e-20);
                float brighter = abs(luminance(value.rgb) - bright) / (edge + 1e-20);
                float facing =
                    surface ? pow(max(dot(around.xyz, guide.xyz), 0.0), NORMAL_POWER) : float(around.xyz == vec3(0.0));
                weight *= facing * exp(-off - brighter);
            }
            sum += weight * vec4(value.rgb, weight * value.w);
            total += weight;
        }
    }
    return sum / vec4(vec3(total), total * total);
}

void main() {
    uint index = invocation_index();
    if (index >= parameters.pixels) return;
    ivec2 pixel = ivec2(index % parameters.width, index / parameters.width);
    signals[index] = smoothed(pixel, ivec2(parameters.width, parameters.pixels / parameters.width) - 1);
}
