// SPDX-License-Identifier: GPL-3.0-or-later

void node_tex_checker(vec3 vector, vec3 color1, vec3 color2, float scale, out vec3 color, out float fac) {
    // Cycles' nudge keeps whole coordinates off the borders.
    ivec3 cell = ivec3(floor((vector * scale + 0.000001) * 0.999999)) & 1;
    bool first = ((cell.x ^ cell.y ^ cell.z) & 1) != 0;
    color = first ? color1 : color2;
    fac = first ? 1.0 : 0.0;
}
