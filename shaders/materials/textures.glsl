// SPDX-License-Identifier: GPL-3.0-or-later
// Lookups in the common texel buffer.

#include "common/half.glsl"
#include <ImageEntry>
readonly buffer Images { ImageEntry images[]; };
readonly buffer Texels { uint texels[]; };

#include <TexelFormats>
#include <ImageSampling>

vec3 srgb_to_linear(vec3 c) {
    return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
}

// GLSL leaves % of negative numbers undefined.
int wrapped(int i, int size) {
    i -= size * int(floor(float(i) / float(size)));
    return clamp(i, 0, size - 1);
}

int extended(int i, int size, int extension) {
    if (extension == EXTENSION_REPEAT) return wrapped(i, size);
    if (extension == EXTENSION_MIRROR) {
        i = wrapped(i, 2 * size);
        return i < size ? i : 2 * size - 1 - i;
    }
    return clamp(i, 0, size - 1);
}

vec4 image_texel(ImageEntry image, ivec2 at, int extension) {
    ivec2 size = ivec2(image.width, image.height);
    bool outside = extension == EXTENSION_CLIP && (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size)));
    at = ivec2(extended(at.x, size.x, extension), extended(at.y, size.y, extension));
    uint index = uint(at.y * size.x + at.x);
    vec4 color;
    if (image.format >= FORMAT_HALF) {
        index = image.first_texel + 2u * index;
        color = vec4(two_halves(texels[index]), two_halves(texels[index + 1u]));
    } else color = unpackUnorm4x8(texels[image.first_texel + index]);
    return outside ? vec4(0.0) : color;
}

vec4 cubic_weights(float t) {
    float t2 = t * t, t3 = t2 * t;
    return vec4(1.0 - 3.0 * t + 3.0 * t2 - t3, 4.0 - 6.0 * t2 + 3.0 * t3, 1.0 + 3.0 * t + 3.0 * t2 - 3.0 * t3, t3)
           / 6.0;
}

vec4 filter_image(ImageEntry image, vec2 uv, int interpolation, int extension) {
    vec2 p = uv * vec2(image.width, image.height);
    if (interpolation == INTERPOLATION_CLOSEST) return image_texel(image, ivec2(floor(p)), extension);
    vec2 cell = floor(p - 0.5), f = p - 0.5 - cell;
    ivec2 i = ivec2(cell);
    if (interpolation == INTERPOLATION_CUBIC || interpolation == INTERPOLATION_SMART) {
        vec4 across = cubic_weights(f.x), upward = cubic_weights(f.y), sum = vec4(0.0);
        for (int k = 0; k < 16; ++k)
            sum += across[k & 3] * upward[k >> 2] * image_texel(image, i + ivec2((k & 3) - 1, (k >> 2) - 1), extension);
        return sum;
    }
    return mix(mix(image_texel(image, i, extension), image_texel(image, i + ivec2(1, 0), extension), f.x),
               mix(image_texel(image, i + ivec2(0, 1), extension), image_texel(image, i + ivec2(1, 1), extension), f.x),
               f.y);
}

// As Cycles does it: filtered while still encoded and multiplied by alpha, then divided where alpha is used on its own.
vec4 sample_image(uint number, vec2 uv, int interpolation, int extension, int divide) {
    ImageEntry image = images[number];
    vec4 color = filter_image(image, uv, interpolation, extension);
    if (divide != 0 && color.a != 1.0 && color.a != 0.0) color.rgb /= color.a;
    if (image.format == FORMAT_SRGB_BYTES || image.format == FORMAT_SRGB_HALF) color.rgb = srgb_to_linear(color.rgb);
    return color;
}
