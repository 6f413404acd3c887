// SPDX-License-Identifier: GPL-3.0-or-later
// Reflectance of a thin film on a base (Belcour and Barla, A Practical Extension to Microfacet Theory for the
// Modeling of Varying Iridescence, 2017), with both polarisations, for one angle of the viewer to the surface.

#include "common/bsdf/fresnel.glsl"
#include "common/constants.glsl"
#include "materials/working_space.glsl"

// Amplitude coefficients of reflection from an index to another, s and p; 1 beyond the critical angle.
vec2 reflection_coefficients(float cosine, float from, float to, out float cosine_beyond) {
    float ratio = from / to, beyond2 = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
    cosine_beyond = sqrt(max(beyond2, 0.0));
    if (beyond2 <= 0.0) return vec2(1.0);
    float s = (from * cosine - to * cosine_beyond) / (from * cosine + to * cosine_beyond);
    float p = (to * cosine - from * cosine_beyond) / (to * cosine + from * cosine_beyond);
    return vec2(s, p);
}

// A metal below a film: indices and extinctions of the three channels, and where `follows` says so the F82 curve of
// the unpolarized reflectance, from f0, that at normal incidence from within the film. No metal: index 0.
struct FilmMetal {
    vec3 index, extinction, f0, tint;
    bool follows;
};

const FilmMetal NO_METAL = FilmMetal(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), false);

// Of a metal that is given by its reflectance f0 and its tint at 82 degrees: indices after Gulbrandsen (Artist Friendly
// Metallic Fresnel, JCGT 2014), between those of least and most extinction by the reflectance at 82 degrees.
FilmMetal metal_below_film(vec3 f0, vec3 tint, float film) {
    f0 = clamp(f0, 1e-4, 0.9999);
    vec3 root = sqrt(f0), edge = f82_reflectance(f0, tint, 1.0 / 7.0);
    vec3 n = mix((1.0 + root) / (1.0 - root), (1.0 - f0) / (1.0 + f0), edge);
    vec3 k2 = max((f0 * (n + 1.0) * (n + 1.0) - (n - 1.0) * (n - 1.0)) / (1.0 - f0), 0.0);
    vec3 below = ((n - film) * (n - film) + k2) / ((n + film) * (n + film) + k2);
    return FilmMetal(n, sqrt(k2), below, tint, true);
}

// Reflectances of a metal, polarized as `parallel` says, and the phases that they add (Born and Wolf, Principles of
// Optics, 14.2); from: the index before it.
vec3 metal_reflectance(FilmMetal metal, float cosine, float from, bool parallel, out vec3 phase) {
    vec3 n = metal.index / from, k = metal.extinction / from, real = n * n - k * k, imaginary = 2.0 * n * k;
    vec3 inside = real - (1.0 - cosine * cosine), size = sqrt(inside * inside + imaginary * imaginary);
    vec3 a = sqrt(max(0.5 * (size + inside), 0.0)), b = sqrt(max(0.5 * (size - inside), 0.0));
    vec3 x = vec3(cosine), y = vec3(0.0);
    if (parallel) {
        x = real * cosine;
        y = imaginary * cosine;
    }
    phase = atan(2.0 * (a * y - b * x), x * x + y * y - a * a - b * b);
    return ((x - a) * (x - a) + (y - b) * (y - b)) / ((x + a) * (x + a) + (y + b) * (y + b));
}

// Fourier transform of the eye's sensitivities at an optical path difference in meters: the paper's sum of
// Gaussians for X, Y and Z, to the working space. shift: of the phases of the channels.
vec3 interference_color(float path_difference, vec3 shift) {
    float phase = 2.0 * PI * path_difference;
    const vec3 height = vec3(5.4856e-13, 4.4201e-13, 5.2481e-13), place = vec3(1.6810e6, 1.7953e6, 2.2084e6),
               variance = vec3(4.3278e9, 9.3046e9, 6.6121e9);
    vec3 reach = height * sqrt(2.0 * PI * variance) * exp(-variance * phase * phase);
    float red = 9.7470e-14 * sqrt(2.0 * PI * 4.5282e9) * exp(-4.5282e9 * phase * phase);
    mat2x3 xyz = mat2x3(reach * cos(place * phase), reach * sin(place * phase));
    xyz[0].x += red * cos(2.2399e6 * phase);
    xyz[1].x += red * sin(2.2399e6 * phase);
    // Without a difference all channels are 1: what does not interfere is white.
    vec3 white = from_rec709(1.0685e-7 * vec3(1.2048843, 0.9483008, 0.9088427));
    return (from_xyz(xyz[0]) * cos(shift) - from_xyz(xyz[1]) * sin(shift)) / white;
}

// thickness in nanometers; indices before the film, of it and behind it; metal: what is behind it, if it is one.
vec3 thin_film_reflectance(float cosine, float thickness, float before, float film, float behind, FilmMetal metal) {
    float cosine_film, cosine_behind;
    vec2 first = reflection_coefficients(cosine, before, film, cosine_film);
    vec2 second = reflection_coefficients(cosine_film, film, behind, cosine_behind);
    float difference = 2.0 * film * thickness * 1e-9 * cosine_film;
    bool on_metal = metal.index.r > 0.0;
    vec3 curve = f82_reflectance(metal.f0, metal.tint, cosine_film);
    vec3 sum = vec3(0.0);
    // How often loops go round is left open for drivers, which else have what interferes six times.
    int polarizations = cosine_film > 0.0 ? 2 : 0, orders = thickness > 0.0 ? 3 : 0;
    for (int k = 0; k < polarizations; ++k) {
        float outer = first[k] * first[k], transmitted = 1.0 - outer;
        vec3 phase, inner = metal_reflectance(metal, cosine_film, film, k == 1, phase);
        if (!on_metal) {
            inner = vec3(second[k] * second[k]);
            phase = vec3(second[k] < 0.0 ? PI : 0.0);
        } else if (metal.follows) inner = curve;
        // Half a wave where the amplitude changes its sign; reflected from within the film, the outer side turns it
        // over.
        vec3 shift = vec3(first[k] > 0.0 ? PI : 0.0) + phase;
        vec3 both = min(outer * inner, 0.9999), repeated = transmitted * transmitted * inner / (1.0 - both),
             term = repeated - transmitted;
        sum += outer + repeated;
        for (int order = 1; order <= orders; ++order) {
            term *= sqrt(both);
            sum += 2.0 * term * interference_color(float(order) * difference, float(order) * shift);
        }
    }
    return cosine_film > 0.0 ? clamp(0.5 * sum, 0.0, 1.0) : vec3(1.0);
}
