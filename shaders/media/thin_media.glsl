// SPDX-License-Identifier: GPL-3.0-or-later
// Media in which photon beams stand for photons at points. The includer includes materials/medium.glsl before.

// least_free_path: the mean free path, meters, of the densest of them.
bool is_thin(vec3 extinction, float least_free_path) {
    return dot(extinction, vec3(1.0 / 3.0)) * least_free_path < 1.0;
}
