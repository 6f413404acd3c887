// SPDX-License-Identifier: GPL-3.0-or-later
// Constants and tables of all materials.

readonly buffer MaterialData { float material_data[]; };

float constant_float(uint at) { return material_data[at]; }
vec3 constant_vec3(uint at) { return vec3(material_data[at], material_data[at + 1u], material_data[at + 2u]); }
// Indices are stored as numbers: small integers' bits would be denormal floats, which devices may flush to zero.
uint constant_index(uint at) { return uint(material_data[at]); }

#include "common/luminance.glsl"
float mean(vec3 v) { return (v.x + v.y + v.z) / 3.0; }
