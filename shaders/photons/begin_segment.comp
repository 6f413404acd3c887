#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Photons of a segment lie behind those of the segments before, one for each path that lives.

layout(local_size_x = 64) in;

#include <BeginSegmentParameters>
#include "common/active_paths.glsl"
uniform Parameters { BeginSegmentParameters parameters; };
buffer PhotonRange;

void main() {
    if (active_place() != 0u) return;
    photon_first = parameters.segment == 0u ? 0u : photon_end;
    photon_end = photon_first + active_header.count;
}
