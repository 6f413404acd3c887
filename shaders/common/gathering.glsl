// SPDX-License-Identifier: GPL-3.0-or-later
#include <Importon>
#include <GatheringVertex>

// What Importon.gathers says: it takes all photons; it leaves INDIRECT ones to the path, which goes on for
// them; it stands where that led, and counts for the vertex that the path set out from.
const uint GATHERS_ALL = 0u, GATHERS_BY_RAY = 1u, GATHERED_BY_RAY = 2u;
