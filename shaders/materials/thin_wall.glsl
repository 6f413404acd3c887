// SPDX-License-Identifier: GPL-3.0-or-later
// The Principled BSDF's base as a thin wall: a sheet without thickness, both sides alike (OpenPBR's thin-walled mode,
// with what Cycles leaves out of it).

#include "materials/lobes.glsl"

// Lobes that pass the sheet with less bend no ray, as in Cycles: a roughness of 0.004 for an index of 1.5.
const float STRAIGHTEST_SHEET = 1.4142e-5;

// What light has been bent twice by microfacets (Kulla and Conty 2017, Revisiting Physically Based Shading at
// Imageworks).
float sheet_alpha(float alpha, float ior) {
    float widening = 3.4 * (ior - 1.0) * (ior - 0.5) * (ior - 0.5) / (ior * ior * ior);
    return min(alpha * sqrt(max(widening, 0.0)), 1.0);
}

// Fractions that a sheet reflects and transmits: Fresnel's at both sides, absorption along the way between them (color
// at normal incidence), and all that goes to and fro within.
void sheet_albedos(float cosine, vec3 color, vec3 tint, Film film, float ior, out vec3 reflected,
                   out vec3 transmitted) {
    float within2 = 1.0 - (1.0 - cosine * cosine) / (ior * ior);
    vec3 outside = tinted_dielectric(cosine, ior, tint), inside = outside;
    if (film.thickness > THINNEST_FILM) {
        outside = thin_film_reflectance(cosine, film.thickness, 1.0, film.ior, ior, NO_METAL);
        // As in Cycles with indices relative to the sheet's, by which the film seems thinner from within.
        inside =
            thin_film_reflectance(sqrt(max(within2, 0.0)), film.thickness, 1.0, film.ior / ior, 1.0 / ior, NO_METAL);
    }
    vec3 kept = within2 > 0.0 ? pow(color, vec3(inversesqrt(within2))) : vec3(0.0), returned = inside * kept;
    transmitted = kept * (1.0 - outside) * (1.0 - inside) / max(1.0 - returned * returned, 1e-6);
    reflected = outside + transmitted * returned;
}

// Facets have the reflectance of the whole; the lost energy is always restored. What passes straight is added.
void thin_glass_lobes(inout ClosureBuilder builder, Microfacets at, vec3 weight, vec3 color, vec3 tint, Film film,
                      float ior, out MicrofacetLobe mirror, out MicrofacetLobe sheet) {
    vec3 reflected, transmitted;
    sheet_albedos(at.cosine, color, tint, film, ior, reflected, transmitted);
    vec3 factor = multiscatter_factor(white_albedos(at), min(tint, vec3(1.0)));
    mirror = mirror_lobe(at, weight * reflected * factor);
    sheet = NO_LOBE;
    at.alpha = sheet_alpha(at.alpha, ior);
    // Seen by the camera itself it is no hole in the picture.
    if (at.alpha > STRAIGHTEST_SHEET || builder.seen_by_camera)
        sheet =
            microfacet_lobe(at, LOBE_SHEET, weight * transmitted * multiscatter_factor(white_albedos(at), vec3(1.0)),
                            vec3(0.0), vec3(1.0), 1.0);
    else builder.closure.transparent += weight * transmitted;
}

// Subsurface scattering within the sheet leaves on both sides; anisotropy 1: all behind, -1: all in front.
void add_thin_subsurface(inout ClosureBuilder builder, vec3 scattered, vec3 diffuse, float anisotropy, vec3 normal,
                         uint roughness) {
    if (roughness != 0u) roughness |= ROUGH_BEHIND;
    float behind = clamp(0.5 + 0.5 * anisotropy, 0.0, 1.0);
    add_diffuse_parts(builder, diffuse + (1.0 - behind) * scattered, behind * scattered, normal, roughness);
}
