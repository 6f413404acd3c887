// SPDX-License-Identifier: GPL-3.0-or-later

// Bits of floats that sort as the floats do, and back.
uvec3 sortable_bits(vec3 v) {
    uvec3 bits = floatBitsToUint(v);
    return bits ^ (uvec3(ivec3(bits) >> 31) | 0x80000000u);
}

vec3 from_sortable_bits(uvec3 bits) { return uintBitsToFloat(bits ^ (((bits >> 31u) - 1u) | 0x80000000u)); }
