#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint:
// lint: MEDIA=1
// A photon meets the importon of one camera pixel.

#include <QuadParameters>
#include "common/photon.glsl"
uniform Parameters { QuadParameters parameters; };
buffer Photons;
readonly buffer Importons;
#include "common/importon.glsl"
#include "density_estimation/splatting/meet.glsl"

flat in uint photon_number;
flat in uint face;

void main() { meet(uint(gl_FragCoord.y) * parameters.width + uint(gl_FragCoord.x), photon_number); }
