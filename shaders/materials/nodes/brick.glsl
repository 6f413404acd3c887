// SPDX-License-Identifier: GPL-3.0-or-later

// A cheap hash of a brick's number, in [0, 1].
float brick_noise(uint n) {
    n = (n + 1013u) & 0x7fffffffu;
    n ^= n >> 13;
    n = (n * (n * n * 60493u + 19990303u) + 1376312589u) & 0x7fffffffu;
    return float(n) / 2147483648.0;
}

// Offset, squash and their frequencies are properties of Blender's node; inputs here, so that they can be moved.
void node_tex_brick(vec3 vector, vec3 color1, vec3 color2, vec3 mortar, float scale, float mortar_size,
                    float mortar_smooth, float bias, float brick_width, float row_height, float offset,
                    float offset_frequency, float squash, float squash_frequency, out vec3 color, out float fac) {
    vec2 p = vector.xy * scale;
    int row = int(floor(p.y / row_height));
    float shift = 0.0;
    int offset_rows = int(offset_frequency), squash_rows = int(squash_frequency);
    if (offset_rows > 0 && squash_rows > 0) {
        if (abs(row) % squash_rows == 0) brick_width *= squash;
        if (abs(row) % offset_rows == 0) shift = brick_width * offset;
    }
    float along = p.x + shift;
    int brick = int(floor(along / brick_width));
    float x = along - brick_width * float(brick);
    float y = p.y - row_height * float(row);
    float tint = clamp(brick_noise((uint(row) << 16) + (uint(brick) & 0xffffu)) + bias, 0.0, 1.0);
    float border = min(min(x, y), min(brick_width - x, row_height - y));
    if (border >= mortar_size) fac = 0.0;
    else if (mortar_smooth == 0.0) fac = 1.0;
    else fac = smoothstep(0.0, 1.0, (1.0 - border / mortar_size) / mortar_smooth);
    color = mix(mix(color1, color2, tint), mortar, fac);
}
