// SPDX-License-Identifier: GPL-3.0-or-later
// Media in which photon beams stand for photons at points. The includer includes materials/medium.glsl before.

bool has_any_grid(uint flags) {
    bool any = has_grid(0u);
    uint bits = medium_bits();
    for (uint set = flags >> FIRST_MEDIUM; set != 0u;) any = has_grid(next_medium(set, bits)) || any;
    return any;
}

// Whether beams are drawn in the media of a path. least_free_path: the mean free path, meters, of the densest of them.
bool is_thin(uint flags, float least_free_path) {
    return dot(even_extinction(flags), vec3(1.0 / 3.0)) * least_free_path < 1.0 && !has_any_grid(flags);
}
