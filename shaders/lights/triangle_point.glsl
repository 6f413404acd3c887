// SPDX-License-Identifier: GPL-3.0-or-later

// A point on the emissive meshes with its pdf by area.
struct TrianglePoint {
    vec3 position;
    vec3 normal;
    EmitterNumber triangle;
    vec3 radiance;
    float pdf;
    float ray_offset;
};
