// SPDX-License-Identifier: GPL-3.0-or-later
// Flags of photon paths. The includer includes common/photon.glsl before.

// The flags of a path as those of a photon.
uint photon_flags(uint path_flags) {
    const uint history = PHOTON_SCATTERED_BY_LOBE | PHOTON_CAUSTIC;
    return (path_flags & PHOTON_FLAG_MASK & ~(history | history >> PHOTON_HISTORY_SHIFT))
           | ((path_flags << PHOTON_HISTORY_SHIFT) & history);
}

// The flags of a path whose last scattering was diffuse or not: diffuse surfaces make caustics of light that other
// lobes sent there.
uint scattered_flags(uint path_flags, bool diffuse) {
    const uint by_lobe = PHOTON_SCATTERED_BY_LOBE >> PHOTON_HISTORY_SHIFT;
    if (!diffuse) return path_flags | by_lobe;
    bool caustic = (path_flags & by_lobe) != 0u;
    return (path_flags & ~by_lobe) | (caustic ? PHOTON_CAUSTIC >> PHOTON_HISTORY_SHIFT : 0u);
}
