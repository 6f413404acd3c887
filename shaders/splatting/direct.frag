#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// A photon meets the importon of one camera pixel; blending adds up.

#include <QuadParameters>
#include <Importon>
#include "common/photon.glsl"
layout(std140, binding = 0) uniform Parameters { QuadParameters parameters; };
layout(std430, binding = 0) readonly buffer Photons { Photon photons[]; };
layout(std430, binding = 1) readonly buffer Importons { Importon importons[]; };
#include "common/importon.glsl"

flat in uint photon_number;
flat in uint face;
layout(location = 0) out vec4 gathered;

void main() {
    uint pixel = uint(gl_FragCoord.y) * parameters.width + uint(gl_FragCoord.x);
    vec3 radiance;
    if (!density_estimate(pixel, photon_number, parameters.wide_radius, radiance)) discard;
    gathered = vec4(radiance, 1.0);
}
