// SPDX-License-Identifier: GPL-3.0-or-later

// The two directions across a surface in which Cycles takes differences, and about which
// the samples of its rays are spread.
void differential_frame(vec3 n, out vec3 x, out vec3 y) {
    x = n.x != n.y || n.x != n.z ? n.zxy - n.yzx : vec3(n.z - n.y, n.x + n.z, -n.y - n.x);
    x = normalize(x);
    y = cross(n, x);
}
