// SPDX-License-Identifier: GPL-3.0-or-later
// Light of the environment that sharp surfaces send to where a path gathers is found by photons and by the gathering
// ray. The power heuristic (Veach 1997, section 9.2) shares it out by what a photon adds there, flux / (pi r)^2 for
// white: where the world is as bright as that, both are as noisy. The share must rest on what both ways know.

// photon_flux: the mean over all lights' photons, W, which are shared out by power. radius: of the importon, meters.
float world_photon_share(float radiance, float photon_flux, float radius) {
    return power_heuristic(radiance, photon_flux / (PI * PI * radius * radius));
}
