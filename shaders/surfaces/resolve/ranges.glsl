// SPDX-License-Identifier: GPL-3.0-or-later
// Hits ordered by the program that evaluates their material: first a range a program, then the hits' numbers.
// A range: first place, length, places taken, a pad, and the groups of its dispatch. Where there is one program, a list
// of paths, which begins like a range, stands for all this.

buffer HitOrder;

#include <Ranges>

uint range_first(uint program) { return hit_order[RANGE_SIZE * program]; }
uint range_length(uint program) { return hit_order[RANGE_SIZE * program + 1u]; }
