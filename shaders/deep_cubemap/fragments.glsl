// SPDX-License-Identifier: GPL-3.0-or-later
// What rasterization leaves behind: a triangle in a cell with its depth interval, in no order.
#include <OverlapFragment>

layout(std430, binding = 14) buffer OverlapFragments { OverlapFragment overlap_fragments[]; };
