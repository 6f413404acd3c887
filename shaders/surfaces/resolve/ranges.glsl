// SPDX-License-Identifier: GPL-3.0-or-later
// Hits ordered by the program that evaluates their material: first a range a program, then the hits' numbers.
// A range: first place, length, places taken, a pad, and the groups of its dispatch. The first range's pad counts the
// paths that have been counted. Where there is one program, a list of paths, which begins like a range, stands for all
// this.

buffer HitOrder;

#include <Ranges>

const uint COUNTED_PATHS = 3u;

uint range_of(uint program) { return RANGE_SIZE * program; }
uint range_first(uint program) { return hit_order[range_of(program)]; }
uint range_length(uint program) { return hit_order[range_of(program) + 1u]; }
