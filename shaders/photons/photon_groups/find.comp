#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// The light groups of photons that leave the lights.

layout(local_size_x = 64) in;

#include <PhotonGroupParameters>
#include "common/invocation.glsl"
uniform Parameters { PhotonGroupParameters parameters; };
#include "lights/light_table.glsl"
readonly buffer Rays;
writeonly buffer PhotonOrigins;
readonly buffer LightGroupTable;
readonly buffer Attributes;
#include "film/light_groups/table.glsl"

void main() {
    uint index = invocation_index();
    if (index < parameters.count)
        photon_origins[index].light_group = light_group(light_of(index), rays[index].source_triangle);
}
