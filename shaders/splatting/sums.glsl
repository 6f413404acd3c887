// SPDX-License-Identifier: GPL-3.0-or-later
// Where the sums of splats lie: for each pixel of the band twice three 64-bit sums, low word first.

const float WORD = 4294967296.0;

uint first_word(uint pixel, bool by_ray) { return 12u * pixel + (by_ray ? 6u : 0u); }
