// SPDX-License-Identifier: GPL-3.0-or-later
// How often a path has been scattered, and how many transparent surfaces it has passed, which are no bounces: two
// numbers in a word. Those of a photon and of the camera path that takes it add up.
#include <Depths>

const uint ONE_BOUNCE = 1u, ONE_TRANSPARENT = 1u << DEPTH_BITS, MAX_DEPTH = (1u << DEPTH_BITS) - 1u;
const uint DEPTH_MASK = (1u << 2u * DEPTH_BITS) - 1u;

uint bounces_of(uint depth) { return depth & MAX_DEPTH; }
uint transparents_of(uint depth) { return (depth >> DEPTH_BITS) & MAX_DEPTH; }
