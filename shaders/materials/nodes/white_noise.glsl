// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/nodes/hash.glsl"

void node_tex_white_noise(int noise_dimensions, vec3 vector, float w, out float value, out vec3 color) {
    if (noise_dimensions == 0) color = hash_to_color(w);
    else if (noise_dimensions == 1) color = hash_to_color(vector.xy);
    else if (noise_dimensions == 2) color = hash_to_color(vector);
    else color = hash_to_color(vec4(vector, w));
    value = color.r;
}
