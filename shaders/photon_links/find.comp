#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// What the lights that photons leave shine on, by number.

layout(local_size_x = 64) in;

#include <PhotonLinkParameters>
#include "common/constants.glsl"
#include "common/invocation.glsl"
layout(std140, binding = 0) uniform Parameters { PhotonLinkParameters parameters; };
#include "lights/light_table.glsl"
layout(std430, binding = 0) readonly buffer Rays;
layout(std430, binding = 1) writeonly buffer PhotonLinks;
layout(std430, binding = 2) readonly buffer Triangles;
#include "lights/emitter_traits.glsl"

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    uint triangle = rays[index].source_triangle;
    photon_links[index] = triangle == NO_TRIANGLE ? lights[light_of(index)].link
                          : emitter_traits(triangle) >> EMITTER_LINK_SHIFT;
}
