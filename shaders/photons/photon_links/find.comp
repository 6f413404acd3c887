#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint:
// lint: EMITTERS=lights/two_levels
// What the lights that photons leave shine on, by number.

layout(local_size_x = 64) in;

#include <PhotonLinkParameters>
#include "common/constants.glsl"
#include "common/invocation.glsl"
uniform Parameters { PhotonLinkParameters parameters; };
#include "lights/light_table.glsl"
readonly buffer Rays;
writeonly buffer PhotonLinks;
readonly buffer Triangles;
#include EMITTERS "lights/one_level/traits.glsl"

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    uint triangle = rays[index].source_triangle;
    photon_links[index] =
        triangle == NO_TRIANGLE ? lights[light_of(index)].link : emitter_traits(triangle) >> EMITTER_LINK_SHIFT;
}
