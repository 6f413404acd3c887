// SPDX-License-Identifier: GPL-3.0-or-later
// Bilinear, repeating lookups in the common texel buffer.

#include <ImageEntry>
layout(std430, binding = 7) readonly buffer Images { ImageEntry images[]; };
layout(std430, binding = 8) readonly buffer Texels { uint texels[]; };

const uint NO_IMAGE = 0xffffffffu;
const uint FORMAT_SRGB = 0u;
const uint FORMAT_HALF = 2u;

vec3 srgb_to_linear(vec3 c) {
    return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
}

vec4 image_texel(ImageEntry image, ivec2 at) {
    ivec2 size = ivec2(image.width, image.height);
    at -= size * ivec2(floor(vec2(at) / vec2(size)));  // GLSL leaves % of negative numbers undefined
    at = clamp(at, ivec2(0), size - 1);
    uint index = uint(at.y * size.x + at.x);
    if (image.format == FORMAT_HALF) {
        index = image.first_texel + 2u * index;
        return vec4(unpackHalf2x16(texels[index]), unpackHalf2x16(texels[index + 1u]));
    }
    vec4 color = unpackUnorm4x8(texels[image.first_texel + index]);
    return image.format == FORMAT_SRGB ? vec4(srgb_to_linear(color.rgb), color.a) : color;
}

vec4 sample_image(uint number, vec2 uv) {
    ImageEntry image = images[number];
    vec2 p = uv * vec2(image.width, image.height) - 0.5;
    vec2 cell = floor(p);
    vec2 f = p - cell;
    ivec2 i = ivec2(cell);
    return mix(mix(image_texel(image, i), image_texel(image, i + ivec2(1, 0)), f.x),
               mix(image_texel(image, i + ivec2(0, 1)), image_texel(image, i + ivec2(1, 1)), f.x), f.y);
}
