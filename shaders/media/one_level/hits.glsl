// SPDX-License-Identifier: GPL-3.0-or-later
// What the search for media asks of hits, all of which are on world triangles.
#include "acceleration/hits/one_level.glsl"

uint material_of(uint triangle) { return attributes[triangle].material; }
