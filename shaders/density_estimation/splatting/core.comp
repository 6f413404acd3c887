#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint:
// lint: MEDIA=1
// Photons near the cubemap's center meet every importon of the core list.

layout(local_size_x = 64) in;

#include <CubeParameters>
#include "common/iteration.glsl"
#include "common/invocation.glsl"
#include "common/photon.glsl"
uniform Parameters { CubeParameters parameters; };
buffer Photons;
readonly buffer StoredPhotons;
readonly buffer Core;
readonly buffer Importons;
#include "common/importon.glsl"
#include "density_estimation/splatting/meet.glsl"

void main() {
    uint index = invocation_index();
    if (index >= parameters.count || core_count == 0u) return;
    uint photon = stored_photons[index];
    vec3 p = photons[photon].position - parameters.center;
    float reach = 3.001 * max(parameters.radius, iteration.wide_radius);
    if (dot(p, p) > reach * reach) return;
    for (uint k = 0u; k < core_count; ++k) meet(core_importons[k], photon);
}
