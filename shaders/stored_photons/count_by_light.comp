#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Of each light, how many of its photons importons might take, how many of these are diffused, and how many were taken.

layout(local_size_x = 64) in;

#include <LightPhotonsParameters>
#include "common/invocation.glsl"
#include "common/photon.glsl"
layout(std140, binding = 0) uniform Parameters { LightPhotonsParameters parameters; };
#include "lights/light_table.glsl"
layout(std430, binding = 0) readonly buffer Photons;
layout(std430, binding = 1) readonly buffer StoredPhotons;
layout(std430, binding = 2) buffer PhotonsByLight { uint photons_by_light[]; };

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    uint number = stored_photons[index], first = 3u * light_of(photon_path_of(photons[number].path));
    atomicAdd(photons_by_light[first], 1u);
    if ((photons[number].flags & PHOTON_AFTER_ROUGH_BOUNCE) != 0u) atomicAdd(photons_by_light[first + 1u], 1u);
    if ((photons[number].depth & PHOTON_CONTRIBUTED) != 0u) atomicAdd(photons_by_light[first + 2u], 1u);
}
