// SPDX-License-Identifier: GPL-3.0-or-later
// Normals as they are. Before the nodes of a material without Bump Map Correction.

#include "materials/builder.glsl"
#define UNCORRECTED_BUMP
#define reflecting_normal given_normal
