// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/nodes/hsv.glsl"
#include <ColorModes>

void node_separate_color(int mode, vec3 color, out float red, out float green, out float blue) {
    vec3 parts = mode == MODE_RGB ? color : (mode == MODE_HSV ? rgb_to_hsv(color) : rgb_to_hsl(color));
    red = parts.x;
    green = parts.y;
    blue = parts.z;
}

void node_combine_color(int mode, float red, float green, float blue, out vec3 color) {
    vec3 parts = vec3(red, green, blue);
    color = mode == MODE_RGB ? parts : (mode == MODE_HSV ? hsv_to_rgb(parts) : hsl_to_rgb(parts));
}

void node_separate_xyz(vec3 vector, out float x, out float y, out float z) {
    x = vector.x;
    y = vector.y;
    z = vector.z;
}

void node_combine_xyz(float x, float y, float z, out vec3 vector) { vector = vec3(x, y, z); }
