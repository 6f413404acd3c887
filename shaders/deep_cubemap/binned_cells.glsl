// SPDX-License-Identifier: GPL-3.0-or-later
// The cells that get depth bins, kept while building: which, how many fragments they hold, and how many
// slices all these touch together. Until its bins are allocated, such a cell's content is its number here.
#include <BinnedCell>

buffer BinnedCells { BinnedCell binned_cells[]; };

uint binned_cell_number(uint content) { return content & 0x3fffffffu; }
