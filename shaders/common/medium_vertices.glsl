// SPDX-License-Identifier: GPL-3.0-or-later
// The number of the vertices of a photon path or a camera path in media, in the bounce_counts of the path.
#include <MediumScattering>

const uint MOST_MEDIUM_VERTICES = 31u;

uint medium_count(uint bounce_counts) { return (bounce_counts >> MEDIUM_COUNT_SHIFT) & MOST_MEDIUM_VERTICES; }

// The counts behind one more vertex in a medium.
uint medium_counted(uint bounce_counts) {
    bool full = medium_count(bounce_counts) == MOST_MEDIUM_VERTICES;
    return full ? bounce_counts : bounce_counts + (1u << MEDIUM_COUNT_SHIFT);
}
