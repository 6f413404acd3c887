// SPDX-License-Identifier: GPL-3.0-or-later
// Where the tiles are, kept while building: the place of the cell that a tile divides, among the cells
// of that cell's level, as x | y << 14 | face << 28.

buffer CubemapTiles { uint cubemap_tiles[]; };

uint pack_place(ivec2 cell, int face) { return uint(cell.x) | uint(cell.y) << 14 | uint(face) << 28; }
ivec2 place_cell(uint place) { return ivec2(place & 0x3fffu, (place >> 14) & 0x3fffu); }
int place_face(uint place) { return int(place >> 28); }

uint tile_of_cell(uint index) { return (index - deep_cubemap.root_count) >> 4; }
uint first_cell_of_tile(uint tile) { return deep_cubemap.root_count + 16u * tile; }
