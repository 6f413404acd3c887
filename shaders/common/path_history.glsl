// SPDX-License-Identifier: GPL-3.0-or-later
// How camera paths came to where they are, for passes of light: a Scatter and the flags of PathHistory.
#include <PathHistory>

const uint HISTORY_FIRST = 3u;  // of the Scatter

// Of an importon: as the path came, and as it goes on; and its depth as it came.
const uint HISTORY_BITS = 5u, HISTORY_MASK = (1u << HISTORY_BITS) - 1u;
uint history_word(uint arrived, uint departing, uint depth) {
    return arrived | departing << HISTORY_BITS | depth << 2u * HISTORY_BITS;
}
uint arrived_history(uint word) { return word & HISTORY_MASK; }
uint departing_history(uint word) { return (word >> HISTORY_BITS) & HISTORY_MASK; }
uint arrived_depth(uint word) { return word >> 2u * HISTORY_BITS; }

uint first_scatter(uint history) { return history & HISTORY_FIRST; }

// The Scatter of a lobe's kind, as Cycles' passes distinguish it.
uint lobe_scatter(uint kind, bool transmitted) {
    if (lobe_is_diffuse(kind)) return SCATTER_DIFFUSE;
    if (lobe_is_hair(kind)) transmitted = kind == LOBE_HAIR_TRANSMISSION;  // light goes all around
    return transmitted ? SCATTER_TRANSMISSION : SCATTER_GLOSSY;
}

// Whether a medium was the first to scatter a path: it has no Scatter of a surface.
bool is_scattered_by_medium(uint history) {
    return first_scatter(history) == SCATTER_NONE && (history & HISTORY_AGAIN) != 0u;
}

uint scattered_history(uint history, uint scatter) {
    if (scatter == SCATTER_NONE) return history;
    uint first = first_scatter(history);
    bool diffuse = scatter == SCATTER_DIFFUSE, caustic = (history & HISTORY_DIFFUSE) != 0u && !diffuse;
    bool is_first = first == SCATTER_NONE && (history & HISTORY_AGAIN) == 0u;
    return (is_first ? scatter : first | HISTORY_AGAIN) | (history & (HISTORY_AGAIN | HISTORY_CAUSTIC))
           | (diffuse ? HISTORY_DIFFUSE : 0u) | (caustic ? HISTORY_CAUSTIC : 0u);
}
