// SPDX-License-Identifier: GPL-3.0-or-later
// Lobes under a thin film, as closures keep them: bare ones with the film in members that they do without, its tint or
// a metal's index. Where f0.x is negative a film lies on metals and dielectrics; on glass the kind says so.

#include "common/half.glsl"

// For programs of scenes with films, and for those that add lobes to closures, which say so beforehand.
#if defined(THIN_FILM_LOBES) || defined(ADDS_LOBES)

#include "common/bsdf/thin_film.glsl"

struct Film {
    float thickness;  // nanometers
    float ior;
};

// Thickness as a half float without its sign, and an index that is anything from 0 on.
uint packed_film(Film film) {
    uint thickness = float_to_half(min(film.thickness, 65000.0));
    return thickness << 13u | uint(8191.0 * film.ior / (1.0 + film.ior) + 0.5);
}
Film unpacked_film(uint word) {
    float part = float(word & 8191u) / 8191.0;
    return Film(half_to_float(word >> 13u), part / max(1.0 - part, 1e-4));
}

// The 28 bits as a float from 2^-16 to 2^16.
const uint LEAST_FILM_BITS = 0x37800000u;

bool lobe_has_film(MicrofacetLobe lobe) {
    return lobe.kind == LOBE_COATED_GLASS
           || ((lobe.kind == LOBE_METAL || lobe.kind == LOBE_DIELECTRIC) && lobe.f0.x < 0.0);
}

Film lobe_film(MicrofacetLobe lobe) {
    uint bits = lobe.kind == LOBE_METAL ? floatBitsToUint(lobe.ior) - LEAST_FILM_BITS : pack_kind(0u, lobe.tint) >> 4u;
    return unpacked_film(bits);
}

// film: with its index over that of the medium before it. A metal of given indices keeps those in
// the place of its tint, one that follows its own curve has a negative f0.y.
MicrofacetLobe covered_lobe(MicrofacetLobe lobe, Film film, bool follows) {
    uint word = packed_film(film);
    if (lobe.kind == LOBE_METAL) lobe.ior = uintBitsToFloat(word + LEAST_FILM_BITS);
    else lobe.tint = unpack_tint(word << 4u);
    if (lobe.kind == LOBE_GLASS) lobe.kind = LOBE_COATED_GLASS;
    else {
        lobe.f0.x = -max(lobe.f0.x, 1e-6);
        if (follows) lobe.f0.y = -max(lobe.f0.y, 1e-6);
    }
    return lobe;
}

// What microfacets of a covered lobe reflect.
vec3 covered_reflectance(MicrofacetLobe lobe, float cosine) {
    Film film = lobe_film(lobe);
    bool is_metal = lobe.kind == LOBE_METAL;
    vec3 f0 = abs(lobe.f0);
    FilmMetal metal = NO_METAL;
    if (is_metal && lobe.f0.y < 0.0) metal = metal_below_film(f0, lobe.tint, film.ior);
    else if (is_metal) metal = metal_of_index(f0, lobe.tint / max(1.0 - lobe.tint, 1e-3));
    vec3 reflectance = thin_film_reflectance(cosine, film.thickness, 1.0, film.ior, is_metal ? 1.0 : lobe.ior, metal);
    return lobe.kind == LOBE_DIELECTRIC ? scaled_film(reflectance, f0, lobe.ior) : reflectance;
}

#endif
