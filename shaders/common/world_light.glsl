// SPDX-License-Identifier: GPL-3.0-or-later
// How light of the environment is shared out between photons and rays, by what both know.

// Caustics where a path gathers, by photons and by the gathering ray: the power heuristic (Veach 1997, section 9.2)
// with what a photon adds there, flux / (pi r)^2 for white: where the world is as bright as that, both are as noisy.
// photon_flux: the mean over all lights' photons, W, most of which are shared out by power. radius: of the importon,
// meters.
float world_photon_share(float radiance, float photon_flux, float radius) {
    return power_heuristic(radiance, photon_flux / (PI * PI * radius * radius));
}

// Pdf of shadow rays, 1/sr, from which on these are left what casts sharp shadows: photons would blur them.
const float SHARP_PDF = 10.0;

// Direct light, where photons bring it because rays seldom leave the scene. photon_flux: of the world's, W, as they are
// of use; pdf: of shadow rays that way, 1/sr.
float photon_mis_weight(float radiance, float pdf, float photon_flux, float radius) {
    float sharpness = pdf / SHARP_PDF;
    return world_photon_share(radiance, photon_flux, radius) / (1.0 + sharpness * sharpness);
}
