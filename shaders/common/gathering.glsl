// SPDX-License-Identifier: GPL-3.0-or-later
#include <Importon>
#include <GatheringVertex>

// Bits of Importon.gathers: it leaves INDIRECT photons to the path, which goes on for them; it stands where that led, and
// counts for the vertex that the path set out from. Without the first bit it takes all photons.
const uint GATHERS_BY_RAY = 1u, GATHERED_BY_RAY = 2u;
