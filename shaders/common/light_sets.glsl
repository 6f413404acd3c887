// SPDX-License-Identifier: GPL-3.0-or-later
// Sets of objects that lights distinguish (rppm_addon/scene/light_linking.py).

#include <TriangleCodes>

// A number below 2^23 and a flag as a float: 0 and -0 are the number 0 without the flag.
float signed_code(bool flag, uint number) { return flag ? 1.0 + float(number) : -float(number); }
uint code_number(float code) { return uint(code > 0.0 ? code - 1.0 : -code); }

// The code of a number without the flag, for light that a mirror reflects: code_number leaves out the half.
float reflected_code(uint number) { return -float(number) - 0.5; }
bool is_reflected_code(float code) { return fract(code) != 0.0; }

// Of a triangle, whose first corner has a code as its fourth component; the flag: it casts no shadow.
uint light_set_of(float code) { return code_number(code) & 63u; }
uint shadow_set_of(float code) { return code_number(code) >> 6u & 63u; }

// Whether rays meet it from outside only.
bool is_one_sided(float code) { return (code_number(code) & ONE_SIDED) != 0u; }

bool has_set(uvec2 membership, uint number) {
    return (((number < 32u ? membership.x : membership.y) >> (number & 31u)) & 1u) != 0u;
}
