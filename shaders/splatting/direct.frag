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
layout(std430, binding = 5) buffer DiffusedPhotons { uint diffused_photons[]; };  // that a pixel's importon took
#include "splatting/gathered.glsl"
#include "common/importon.glsl"

flat in uint photon_number;
flat in uint face;

void main() {
    uint pixel = uint(gl_FragCoord.y) * parameters.width + uint(gl_FragCoord.x);
    vec3 radiance;
    if (rejected(photon_number, pixel)) return;
    if (!density_estimate(pixel, photon_number, parameters.wide_radius, radiance)) return;
    add_gathered(pixel, photon_number, radiance, parameters.quanta);
    if (parameters.counting != 0u && (photons[photon_number].flags & PHOTON_DIFFUSED) != 0u) atomicAdd(diffused_photons[pixel], 1u);
}
