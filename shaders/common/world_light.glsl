// SPDX-License-Identifier: GPL-3.0-or-later
// MIS weights by which photons and rays both bring light of the environment.

// MIS weight of photons that bring a caustic to the origin of a final gather, whose ray brings it as well: the power
// heuristic (Veach 1997, section 9.2) with the radiance that a photon adds to white there, flux / (pi r)^2. Where the
// environment is as bright as that, both techniques are as noisy. photon_flux: the mean of all lights' photons, W, most
// of which are allocated by power. radius: of the importon, meters.
float photon_power_heuristic(float radiance, float photon_flux, float radius) {
    return power_heuristic(radiance, photon_flux / (PI * PI * radius * radius));
}
