#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Counts the photons of each bucket of cells.

layout(local_size_x = 64) in;

#include <MediumGridParameters>
#include "common/invocation.glsl"
#include "common/photon.glsl"
#include "density_estimation/photon_grid/cells.glsl"
uniform Parameters { MediumGridParameters parameters; };
readonly buffer Photons;
readonly buffer MediumPhotons;
buffer Buckets;

void main() {
    uint place = invocation_index();
    if (place >= medium_photon_count) return;
    vec3 position = photons[medium_photons[place]].position;
    atomicAdd(buckets[bucket_of(cell_of(position, parameters.side), parameters.buckets)].y, 1u);
}
