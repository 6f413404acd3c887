// SPDX-License-Identifier: GPL-3.0-or-later
// The lists themselves; bins.glsl explains the entries.

#ifdef DEEP_CUBEMAP_BUILD
#define CELL_ENTRIES_ACCESS writeonly
#else
#define CELL_ENTRIES_ACCESS restrict readonly
#endif

layout(std430, binding = 12) CELL_ENTRIES_ACCESS buffer CellEntries { uvec2 cell_entries[]; };
