#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Sorts the photons into the ranges of their buckets.

layout(local_size_x = 64) in;

#include <MediumGridParameters>
#include "common/invocation.glsl"
#include "common/photon.glsl"
#include "density_estimation/photon_grid/cells.glsl"
uniform Parameters { MediumGridParameters parameters; };
readonly buffer Photons;
readonly buffer MediumPhotons;
buffer Buckets;
writeonly buffer SortedPhotons;

void main() {
    uint place = invocation_index();
    if (place >= medium_photon_count) return;
    uint number = medium_photons[place];
    vec3 position = photons[number].position;
    uint bucket = bucket_of(cell_of(position, parameters.side), parameters.buckets);
    sorted_photons[atomicAdd(buckets[bucket].y, 1u)] = uvec4(floatBitsToUint(position), number);
}
