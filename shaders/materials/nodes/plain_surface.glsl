// SPDX-License-Identifier: GPL-3.0-or-later
// What stands in for materials (rppm_addon/materials/placeholders/stand_in.py): little code, compiled in no time.

#include "materials/lobes.glsl"

// texture_factor: 1 where the color is that of a texture, tinted, 0 where there is none. Share `transparent` is passed
// unbent, the fraction `glass` of the rest is glass, if it is the greater part.
void node_plain_surface(inout ClosureBuilder builder, float weight, vec3 color, vec3 texel, float texture_factor,
                        float metallic, float roughness, float glass, float transparent, vec3 emission) {
    const float dielectric = 0.04, index = 1.45;
    color *= mix(vec3(1.0), texel, texture_factor);
    builder.closure.transparent += weight * transparent;
    builder.closure.emission += weight * emission;
    weight *= 1.0 - transparent;
    Microfacets at = isotropic_microfacets(builder, builder.shading, roughness);
    float shine = metallic + (1.0 - metallic) * (1.0 - roughness) * dielectric;
    bool is_glass = glass > 0.5;
    MicrofacetLobe lobe = mirror_lobe(at, weight * shine * mix(vec3(1.0), color, metallic));
    if (is_glass)
        lobe = microfacet_lobe(at, LOBE_GLASS, vec3(weight), weight * color, vec3(1.0), relative_ior(builder, index));
    else builder.closure.diffuse = weight * (1.0 - shine) * color;
    hold_lobe(builder, 0, lobe);
    builder.lobes = 1;
}
