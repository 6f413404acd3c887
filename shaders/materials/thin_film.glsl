// SPDX-License-Identifier: GPL-3.0-or-later
// Reflectance of a thin film on a base (Belcour and Barla, A Practical Extension to Microfacet Theory for the
// Modeling of Varying Iridescence, 2017), with both polarisations, for one angle of the viewer to the surface.

#include "common/bsdf/fresnel.glsl"
#include "common/constants.glsl"

// Amplitude coefficients of reflection from an index to another, s and p; 1 beyond the critical angle.
vec2 reflection_coefficients(float cosine, float from, float to, out float cosine_beyond) {
    float ratio = from / to, beyond2 = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
    cosine_beyond = sqrt(max(beyond2, 0.0));
    if (beyond2 <= 0.0) return vec2(1.0);
    float s = (from * cosine - to * cosine_beyond) / (from * cosine + to * cosine_beyond);
    float p = (to * cosine - from * cosine_beyond) / (to * cosine + from * cosine_beyond);
    return vec2(s, p);
}

// Fourier transform of the eye's sensitivities at an optical path difference in meters: the paper's sum of
// Gaussians for X, Y and Z, to linear Rec.709.
vec3 interference_color(float path_difference, float shift) {
    float phase = 2.0 * PI * path_difference;
    const vec3 height = vec3(5.4856e-13, 4.4201e-13, 5.2481e-13), place = vec3(1.6810e6, 1.7953e6, 2.2084e6),
               variance = vec3(4.3278e9, 9.3046e9, 6.6121e9);
    vec3 xyz = height * sqrt(2.0 * PI * variance) * cos(place * phase + shift) * exp(-variance * phase * phase);
    xyz.x += 9.7470e-14 * sqrt(2.0 * PI * 4.5282e9) * cos(2.2399e6 * phase + shift) * exp(-4.5282e9 * phase * phase);
    xyz /= 1.0685e-7;
    // Without a difference all channels are 1: what does not interfere is white.
    return vec3(dot(xyz, vec3(3.2404542, -1.5371385, -0.4985314)), dot(xyz, vec3(-0.9692660, 1.8760108, 0.0415560)),
                dot(xyz, vec3(0.0556434, -0.2040259, 1.0572252))) / vec3(1.2048843, 0.9483008, 0.9088427);
}

// thickness in nanometers; indices before the film, of it and behind it; base: the reflectances of the base under
// the film at normal incidence per channel, for Schlick's curve; where base.r < 0 they are Fresnel's own.
vec3 thin_film_reflectance(float cosine, float thickness, float before, float film, float behind, vec3 base) {
    float cosine_film, cosine_behind;
    vec2 first = reflection_coefficients(cosine, before, film, cosine_film);
    vec2 second = reflection_coefficients(cosine_film, film, behind, cosine_behind);
    float difference = 2.0 * film * thickness * 1e-9 * cosine_film;
    if (base.r >= 0.0) base = mix(base, vec3(1.0), schlick_interpolation(cosine_film));
    vec3 sum = vec3(0.0);
    // How often loops go round is left open for drivers, which else have what interferes six times.
    int polarizations = cosine_film > 0.0 ? 2 : 0, orders = thickness > 0.0 ? 3 : 0;
    for (int k = 0; k < polarizations; ++k) {
        float outer = first[k] * first[k], passed = 1.0 - outer;
        vec3 inner = base.r >= 0.0 ? base : vec3(second[k] * second[k]);
        // Half a wave where the amplitude changes its sign; reflected from within the film, the outer side turns it
        // over.
        float shift = (first[k] > 0.0 ? PI : 0.0) + (base.r >= 0.0 || second[k] < 0.0 ? PI : 0.0);
        vec3 both = clamp(outer * inner, 1e-5, 0.9999), repeated = passed * passed * inner / (1.0 - both),
            term = repeated - passed;
        sum += outer + repeated;
        for (int order = 1; order <= orders; ++order) {
            term *= sqrt(both);
            sum += 2.0 * term * interference_color(float(order) * difference, float(order) * shift);
        }
    }
    return cosine_film > 0.0 ? clamp(0.5 * sum, 0.0, 1.0) : vec3(1.0);
}
