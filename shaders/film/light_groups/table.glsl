// SPDX-License-Identifier: GPL-3.0-or-later
// Whose light it is. The includer declares the blocks LightGroupTable and Attributes.
#include "common/iteration.glsl"
#include <LightGroups>
#include <Distances>

// Of an emissive triangle, or without one (NO_TRIANGLE) of a light.
uint light_group(uint light, uint triangle) {
    return light_group_table[triangle == NO_TRIANGLE ? light : iteration.light_count + attributes[triangle].instance];
}
