// SPDX-License-Identifier: GPL-3.0-or-later
// Hashes of whole numbers and of the bits of floats: Bob Jenkins' lookup3 (2006), as Cycles' noises use it.

uint rotate_left(uint x, int bits) { return (x << bits) | (x >> (32 - bits)); }

// Hash of the first 1 to 4 words of a key; words is a literal.
uint hash_words(int words, uvec4 key) {
    uint start = 0xdeadbeefu + uint(4 * words) + 13u;
    uint a = start + key.x;
    uint b = words > 1 ? start + key.y : start;
    uint c = words > 2 ? start + key.z : start;
    if (words > 3) {
        a -= c;
        a ^= rotate_left(c, 4);
        c += b;
        b -= a;
        b ^= rotate_left(a, 6);
        a += c;
        c -= b;
        c ^= rotate_left(b, 8);
        b += a;
        a -= c;
        a ^= rotate_left(c, 16);
        c += b;
        b -= a;
        b ^= rotate_left(a, 19);
        a += c;
        c -= b;
        c ^= rotate_left(b, 4);
        b += a;
        a += key.w;
    }
    c ^= b;
    c -= rotate_left(b, 14);
    a ^= c;
    a -= rotate_left(c, 11);
    b ^= a;
    b -= rotate_left(a, 25);
    c ^= b;
    c -= rotate_left(b, 16);
    a ^= c;
    a -= rotate_left(c, 4);
    b ^= a;
    b -= rotate_left(a, 14);
    c ^= b;
    c -= rotate_left(b, 24);
    return c;
}

// In [0, 1], both included, from the bits of as many floats.
float hash_to_unit(float k) { return float(hash_words(1, uvec4(floatBitsToUint(k), 0u, 0u, 0u))) / 4294967296.0; }
float hash_to_unit(vec2 k) { return float(hash_words(2, uvec4(floatBitsToUint(k), 0u, 0u))) / 4294967296.0; }
float hash_to_unit(vec3 k) { return float(hash_words(3, uvec4(floatBitsToUint(k), 0u))) / 4294967296.0; }
float hash_to_unit(vec4 k) { return float(hash_words(4, floatBitsToUint(k))) / 4294967296.0; }

vec3 hash_to_color(float k) { return vec3(hash_to_unit(k), hash_to_unit(vec2(k, 1.0)), hash_to_unit(vec2(k, 2.0))); }
vec3 hash_to_color(vec2 k) { return vec3(hash_to_unit(k), hash_to_unit(vec3(k, 1.0)), hash_to_unit(vec3(k, 2.0))); }
vec3 hash_to_color(vec3 k) { return vec3(hash_to_unit(k), hash_to_unit(vec4(k, 1.0)), hash_to_unit(vec4(k, 2.0))); }
vec3 hash_to_color(vec4 k) { return vec3(hash_to_unit(k), hash_to_unit(k.zxwy), hash_to_unit(k.wzyx)); }
