// SPDX-License-Identifier: GPL-3.0-or-later
// Colors of glowing bodies and of single wavelengths, in the working space without negative parts.

#include "common/working_space.glsl"

// Planck's spectrum seen by the CIE 1931 observer, of luminance 1: quotients of polynomials in 1000 K / T,
// fitted to 4.4e-4 over 800 K to 12000 K. Colder and hotter bodies look like those at the ends, as in Cycles.
void node_blackbody(float temperature, out vec3 color) {
    float u = 1000.0 / clamp(temperature, 800.0, 12000.0);
    vec3 over = vec3(0.69108319, 0.99108806, 2.2416123)
                + u
                      * (vec3(2.4464635, 13.34771, 0.016800082)
                         + u
                               * (vec3(19.178313, 48.711195, -18.603495)
                                  + u
                                        * (vec3(-13.442763, -87.610375, 27.969459)
                                           + u
                                                 * (vec3(-0.99096182, 29.124568, -17.445843)
                                                    + u * vec3(1.1167863, -2.6370172, 4.0517044)))));
    vec3 under = 1.0 + u * (vec3(2.9819554, 14.070799, 2.9943172) + u * vec3(-2.0254439, 33.591686, 15.679012));
    color = max(from_rec709(over / under), 0.0);
}

// A bell whose sides fall off differently: of this height at `center`, `low` and `high` are 1 / standard deviation.
float bell(float nanometers, float height, float center, float low, float high) {
    float x = (nanometers - center) * (nanometers < center ? low : high);
    return height * exp(-0.5 * x * x);
}

// The CIE 1931 observer's x, y, z for a wavelength, as sums of bells (a form of Wyman, Sloan and Shirley, JCGT
// 2013), fitted to 3e-3, 1.5e-3 and 5e-3.
vec3 observer(float nanometers) {
    float n = nanometers;
    return vec3(
        bell(n, 0.148759, 432.95962, 0.106154, 0.074388) + bell(n, 1.01272, 595.269857, 0.032311, 0.033209)
            + bell(n, -0.04681, 514.138722, 0.078544, 0.092355) + bell(n, 0.129551, 620.996136, 0.058445, 0.030251)
            + bell(n, 0.28013, 456.107916, 0.044234, 0.062366) + bell(n, 0.089433, 546.066975, 0.040912, 0.057794),
        bell(n, 1.483803, 589.056797, 0.021873, 0.023164) + bell(n, 0.273449, 525.874925, 0.059603, 0.045466)
            + bell(n, 0.045685, 483.002128, 0.035404, 0.073108) + bell(n, -0.820043, 605.549086, 0.031111, 0.025034),
        bell(n, 0.315486, 429.951001, 0.143176, 0.067297) + bell(n, 0.917873, 459.722453, 0.040083, 0.076416)
            + bell(n, 0.090369, 482.206054, 0.147119, 0.054048) + bell(n, 0.826701, 440.572409, 0.071883, 0.027921));
}

// Cycles tabulates the observer every 5 nm from 380 to 780, joins the points by straight lines, of which the first
// reaches down to 375, and scales so that no color exceeds 1.
void node_wavelength(float wavelength, out vec3 color) {
    color = vec3(0.0);
    if (wavelength <= 375.0 || wavelength >= 780.0) return;
    float knot = 380.0 + 5.0 * trunc((wavelength - 380.0) / 5.0);
    vec3 xyz = mix(observer(knot), observer(knot + 5.0), (wavelength - knot) / 5.0);
    color = max(from_xyz(xyz), 0.0) / 2.52;
}
