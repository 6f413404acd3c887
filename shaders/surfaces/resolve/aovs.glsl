// SPDX-License-Identifier: GPL-3.0-or-later
// What materials with AOV Output nodes write them to; the text of the materials includes it.

#define MATERIAL_AOVS
// Of each path of a band the channels of all AOVs.
buffer AovValues;

void add_aov(uint at, float value) {
#ifdef NODE_RAYS
    if (asks_rays()) return;
#endif
    aov_values[at] += value;
}
void add_aov(uint at, vec3 color) {
    add_aov(at, color.r);
    add_aov(at + 1u, color.g);
    add_aov(at + 2u, color.b);
    add_aov(at + 3u, 1.0);
}
