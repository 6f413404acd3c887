// SPDX-License-Identifier: GPL-3.0-or-later
// Reflectance of a thin film on a base (Belcour and Barla, A Practical Extension to Microfacet Theory for the
// Modeling of Varying Iridescence, 2017), with both polarisations.

#include "common/bsdf/fresnel.glsl"
#include "common/constants.glsl"
#include "common/working_space.glsl"

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

// Extinctions that give metals of such indices a reflectance at normal incidence.
vec3 squared_extinction(vec3 f0, vec3 n) {
    return max((f0 * (n + 1.0) * (n + 1.0) - (n - 1.0) * (n - 1.0)) / (1.0 - f0), 0.0);
}

FilmMetal metal_of_index(vec3 f0, vec3 n) {
    return FilmMetal(max(n, 1e-3), sqrt(squared_extinction(min(f0, 0.9999), n)), f0, vec3(1.0), false);
}

// Of a metal that is given by its reflectance f0 and its tint at 82 degrees: indices after Gulbrandsen (Artist Friendly
// Metallic Fresnel, JCGT 2014), between those of least and most extinction by the reflectance at 82 degrees.
FilmMetal metal_below_film(vec3 f0, vec3 tint, float film) {
    f0 = clamp(f0, 1e-4, 0.9999);
    vec3 root = sqrt(f0), edge = f82_reflectance(f0, tint, 1.0 / 7.0);
    vec3 n = mix((1.0 + root) / (1.0 - root), (1.0 - f0) / (1.0 + f0), edge);
    vec3 k2 = squared_extinction(f0, n);
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

// Of a sum of Gaussians over wave numbers in 1/um, the cosine and the sine parts of the Fourier transform.
void add_gaussians(inout mat2x3 transform, vec3 weight, vec3 place, vec3 width, float phase) {
    vec3 reach = weight * exp(-0.5 * phase * phase * width * width);
    transform[0] += reach * cos(place * phase);
    transform[1] += reach * sin(place * phase);
}

// Fourier transform of the CIE 1931 observer at an optical path difference in meters, to the working space, as sums of
// Gaussians that were fitted to 1e-3 in X, Y and Z. Without a difference all channels are 1: what does not interfere is
// white. shift: of the phases of the channels.
vec3 interference_color(float path_difference, vec3 shift) {
    float phase = 2e6 * PI * path_difference;
    mat2x3 xyz = mat2x3(0.0);
    add_gaussians(xyz, vec3(0.512455, 0.635165, 0.196409), vec3(1.713879, 1.815801, 2.300014),
                  vec3(0.099605, 0.096142, 0.054267), phase);
    add_gaussians(xyz, vec3(0.328783, 0.157303, 0.589872), vec3(1.636352, 1.923885, 2.189158),
                  vec3(0.06759, 0.163076, 0.127475), phase);
    add_gaussians(xyz, vec3(0.166919, 0.24, 0.213249), vec3(2.228024, 1.660921, 2.176387),
                  vec3(0.100891, 0.077687, 0.060993), phase);
    add_gaussians(xyz, vec3(-0.014381, -0.032433, 0.0), vec3(1.976831, 1.827858, 0.0), vec3(0.06338, 0.040731, 0.0),
                  phase);
    add_gaussians(xyz, vec3(0.005805, 0.0, 0.0), vec3(2.324325, 0.0, 0.0), vec3(0.013156, 0.0, 0.0), phase);
    return (from_xyz(xyz[0]) * cos(shift) - from_xyz(xyz[1]) * sin(shift)) / from_xyz(vec3(1.0));
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

// A film's reflectance over a dielectric whose own at normal incidence is f0 in place of what its index says: as in
// Cycles, the further from all it reflects the more it has of f0.
vec3 scaled_film(vec3 reflectance, vec3 f0, float ior) {
    float bare = normal_reflectance(ior);
    if (bare <= 1e-5) return reflectance;
    return reflectance * mix(vec3(1.0), f0 / bare, clamp((1.0 - reflectance) / (1.0 - bare), 0.0, 1.0));
}
