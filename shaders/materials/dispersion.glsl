// SPDX-License-Identifier: GPL-3.0-or-later
// Refraction by wavelength: rppm_addon/materials/dispersion.py. Before the nodes of a material that disperses, whose
// lobes from here on are those of the path's wavelength.

#include "materials/builder.glsl"
#include "materials/albedo_tables.glsl"
#include "common/working_space.glsl"
#include <DispersionTable>
#define DISPERSES

// Of the path: whether its light is white still, the color that it then gets, and by how much its index differs from n,
// times (n - 1) over the Abbe number. Set before nodes are evaluated.
bool path_is_white = false;
vec3 wavelength_color = vec3(1.0);
float wavelength_shift = 0.0;
float inverse_abbe_number = 0.0;

// u: in [0, 1), of which all values are alike in probability.
void take_wavelength(float u, bool white) {
    float place = u * float(WAVELENGTH_STEPS);
    int step = min(whole_part(place), WAVELENGTH_STEPS - 1), at = DISPERSION_TABLE + 4 * step;
    float f = place - float(step);
    vec4 knots[2];
    for (int k = 0; k < 2; ++k)
        knots[k] = vec4(albedo_tables[at + 4 * k], albedo_tables[at + 4 * k + 1], albedo_tables[at + 4 * k + 2],
                        albedo_tables[at + 4 * k + 3]);
    vec4 value = mix(knots[0], knots[1], f);
    path_is_white = white;
    if (white) wavelength_color = from_rec709(value.rgb);
    wavelength_shift = value.a;
}

// The index of what is denser, where on either side something else than air is not known.
float dispersed_ior(float ior, float shift) {
    float dense = max(ior, 1.0 / ior);
    dense += (dense - 1.0) * inverse_abbe_number * shift;
    return ior < 1.0 ? 1.0 / dense : dense;
}

// White light that is reflected has this color in the mean, as wavelengths with a higher index are reflected more. Near
// enough, reflectance is linear in the index.
vec3 reflected_color(float ior, float cosine) {
    float reflectance = fresnel_dielectric(cosine, ior),
          rise = fresnel_dielectric(cosine, dispersed_ior(ior, 1.0)) - reflectance;
    vec3 shifts = vec3(SHIFT_OF_CHANNELS[0], SHIFT_OF_CHANNELS[1], SHIFT_OF_CHANNELS[2]);
    return 1.0 + shifts * (rise / max(reflectance, 1e-6));
}

void add_dispersed_lobe(inout ClosureBuilder builder, MicrofacetLobe lobe) {
    if (lobe.kind >= LOBE_GLASS && lobe.kind <= LOBE_COATED_GLASS) {
        float ior = lobe.ior;
        lobe.ior = dispersed_ior(ior, wavelength_shift);
        if (passes_by_f0(lobe.kind)) lobe.f0 *= wavelength_color;
        if (is_dispersed(lobe, lobe.kind == LOBE_REFRACTION)) lobe.weight *= wavelength_color;
        else if (path_is_white && lobe.kind == LOBE_GLASS)
            lobe.weight *= reflected_color(ior, lobe_cosine(lobe, builder.viewer));
    }
    add_lobe(builder, lobe);
}
#define add_lobe add_dispersed_lobe
