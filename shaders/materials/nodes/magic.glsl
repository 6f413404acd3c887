// SPDX-License-Identifier: GPL-3.0-or-later

// Remainder by the float nearest 2 pi, of the sign of p: the divisor in two parts, so that products stay exact.
vec3 magic_wrapped(vec3 p) {
    const float HIGH = 6.28125, LOW = 0.0019354820251464844;
    vec3 turns = trunc(p / (HIGH + LOW));
    return (p - turns * HIGH) - turns * LOW;
}

void node_tex_magic(int turbulence_depth, vec3 vector, float scale, float distortion, out vec3 color, out float fac) {
    vec3 p = magic_wrapped(vector);
    float x = sin((p.x + p.y + p.z) * 5.0 * scale);
    float y = cos((-p.x + p.y - p.z) * 5.0 * scale);
    float z = -cos((-p.x - p.y + p.z) * 5.0 * scale);
    if (turbulence_depth > 0) {
        x *= distortion;
        y *= distortion;
        z *= distortion;
        y = -distortion * cos(x - y + z);
    }
    if (turbulence_depth > 1) x = distortion * cos(x - y - z);
    if (turbulence_depth > 2) z = distortion * sin(-x - y - z);
    if (turbulence_depth > 3) x = -distortion * cos(-x + y - z);
    if (turbulence_depth > 4) y = -distortion * sin(-x + y + z);
    if (turbulence_depth > 5) y = -distortion * cos(-x + y + z);
    if (turbulence_depth > 6) x = distortion * cos(x + y + z);
    if (turbulence_depth > 7) z = distortion * sin(x + y - z);
    if (turbulence_depth > 8) x = -distortion * cos(-x - y + z);
    if (turbulence_depth > 9) y = -distortion * sin(x - y + z);
    vec3 wave = vec3(x, y, z);
    color = 0.5 - (distortion != 0.0 ? wave / (2.0 * distortion) : wave);
    fac = (color.r + color.g + color.b) / 3.0;
}
