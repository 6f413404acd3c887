#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// DirectPhotonHits, first half: photons leave the lights (paper section 4.3).

layout(local_size_x = 64) in;

#include <Ray>
#include <PhotonPath>
#include <EmitParameters>
#include "common/invocation.glsl"
#include "common/low_discrepancy.glsl"
layout(std140, binding = 0) uniform Parameters { EmitParameters parameters; };
#include "emission/lights.glsl"
layout(std430, binding = 0) writeonly buffer Rays { Ray rays[]; };
layout(std430, binding = 1) writeonly buffer PhotonPaths { PhotonPath photon_paths[]; };

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    uint number = light_of(index);
    Light light = lights[number];
    uint within = index - light.first_photon;
    // A fresh scrambled set for every light and iteration, stratified among the light's photons.
    uvec4 seed = pcg4d(uvec4(number, parameters.iteration, parameters.seed, STAGE_EMISSION));
    vec2 u_position = scrambled_sobol(within, seed);
    vec2 u_direction = scrambled_sobol(within, pcg4d(seed));
    float u_choice = scrambled_sobol(within, pcg4d(seed + 1u)).x;
    Emission emission = emit_photon(light, u_position, u_direction, u_choice);
    vec3 flux = emission.flux / float(max(light.photon_count, 1u));
    bool dark = !(largest(flux) > 0.0);
    photon_paths[index] = PhotonPath(dark ? vec3(0.0) : flux, 0u);
    rays[index] = Ray(emission.origin, emission.triangle, emission.direction, dark ? 0.0 : INFINITY_DISTANCE);
}
