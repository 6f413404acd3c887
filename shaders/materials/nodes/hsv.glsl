// SPDX-License-Identifier: GPL-3.0-or-later
// Hue, saturation, value and lightness of RGB colors (A. R. Smith, SIGGRAPH 1978), hue in [0, 1).

// Sixths of the circle from red. `chroma` = largest - smallest is not 0.
float hue_of(vec3 rgb, float largest_part, float chroma) {
    float sixths;
    if (rgb.r == largest_part) sixths = (rgb.g - rgb.b) / chroma;
    else if (rgb.g == largest_part) sixths = 2.0 + (rgb.b - rgb.r) / chroma;
    else sixths = 4.0 + (rgb.r - rgb.g) / chroma;
    float hue = sixths / 6.0;
    return hue < 0.0 ? hue + 1.0 : hue;
}

vec3 rgb_to_hsv(vec3 rgb) {
    float value = max(rgb.r, max(rgb.g, rgb.b));
    float chroma = value - min(rgb.r, min(rgb.g, rgb.b));
    float saturation = value != 0.0 ? chroma / value : 0.0;
    return vec3(saturation != 0.0 ? hue_of(rgb, value, chroma) : 0.0, saturation, value);
}

// Hues beyond the circle are taken for those of the last sixth, as Cycles does.
vec3 hsv_to_rgb(vec3 hsv) {
    if (hsv.y == 0.0) return vec3(hsv.z);
    float sixths = hsv.x == 1.0 ? 0.0 : hsv.x * 6.0;
    float sector = floor(sixths);
    float part = sixths - sector;
    float low = hsv.z * (1.0 - hsv.y);
    float falling = hsv.z * (1.0 - hsv.y * part);
    float rising = hsv.z * (1.0 - hsv.y * (1.0 - part));
    if (sector == 0.0) return vec3(hsv.z, rising, low);
    if (sector == 1.0) return vec3(falling, hsv.z, low);
    if (sector == 2.0) return vec3(low, hsv.z, rising);
    if (sector == 3.0) return vec3(low, falling, hsv.z);
    if (sector == 4.0) return vec3(rising, low, hsv.z);
    return vec3(hsv.z, low, falling);
}

vec3 rgb_to_hsl(vec3 rgb) {
    float high = max(rgb.r, max(rgb.g, rgb.b)), low = min(rgb.r, min(rgb.g, rgb.b));
    float chroma = high - low, lightness = min(1.0, 0.5 * (high + low));
    if (chroma == 0.0) return vec3(0.0, 0.0, lightness);
    float saturation = lightness > 0.5 ? chroma / (2.0 - high - low) : chroma / (high + low);
    return vec3(hue_of(rgb, high, chroma), saturation, lightness);
}

vec3 hsl_to_rgb(vec3 hsl) {
    vec3 pure = clamp(vec3(-1.0, 2.0, 2.0) + vec3(1.0, -1.0, -1.0) * abs(hsl.x * 6.0 - vec3(3.0, 2.0, 4.0)), 0.0, 1.0);
    float chroma = (1.0 - abs(2.0 * hsl.z - 1.0)) * hsl.y;
    return (pure - 0.5) * chroma + hsl.z;
}
