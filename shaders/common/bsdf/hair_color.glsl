// SPDX-License-Identifier: GPL-3.0-or-later

// Many fibers seen together have a color whose logarithm is the root of their absorption, over the radius, times minus
// this (Chiang et al. 2016, eq. 9).
float hair_color_scale(float radial_roughness) {
    float x = radial_roughness;
    return ((((0.245 * x + 5.574) * x - 10.73) * x + 2.532) * x - 0.215) * x + 5.969;
}
