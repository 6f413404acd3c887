#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// A photon meets the importon of one camera pixel.

#include <QuadParameters>
#include <Importon>
#include "common/photon.glsl"
layout(std140, binding = 0) uniform Parameters { QuadParameters parameters; };
#include "splatting/roulette.glsl"
layout(std430, binding = 0) buffer Photons { Photon photons[]; };
layout(std430, binding = 1) readonly buffer Importons { Importon importons[]; };
#include "common/importon.glsl"
#include "splatting/gathered.glsl"
#include "splatting/diffused.glsl"

flat in uint photon_number;
flat in uint face;

void main() {
    uint pixel = uint(gl_FragCoord.y) * parameters.width + uint(gl_FragCoord.x);
    vec3 radiance;
    if (rejected(photon_number, pixel)) return;
    if (!density_estimate(pixel, photon_number, parameters.wide_radius, radiance)) return;
    add_gathered(pixel, photon_number, radiance, parameters.quanta);
    count_diffused(pixel, photon_number, parameters.counting);
}
