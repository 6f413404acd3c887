// SPDX-License-Identifier: GPL-3.0-or-later

// By the exponent's bits: compilers may assume that no float is NaN.
bool is_finite(vec3 v) { return all(notEqual(floatBitsToUint(v) & 0x7f800000u, uvec3(0x7f800000u))); }
