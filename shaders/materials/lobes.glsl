// SPDX-License-Identifier: GPL-3.0-or-later
// The lobes of shader nodes, with the energy that Cycles gives them.

#include "materials/builder.glsl"
#include "materials/albedo_tables.glsl"

// Films thinner than this, nm, are none.
const float THINNEST_FILM = 0.1;

// Where a node's microfacets lie: normal packed and unpacked, anisotropy packed, roughness of the mean alpha.
struct Microfacets {
    vec3 normal;
    uint packed_normal;
    uint anisotropy;
    float alpha;
    float cosine;
};

Microfacets isotropic_microfacets(ClosureBuilder builder, vec3 normal, float roughness) {
    uint packed_normal = pack_unit_vector(reflecting_normal(builder, normal));
    vec3 n = unpack_unit_vector(packed_normal);
    return Microfacets(n, packed_normal, ISOTROPIC, roughness * roughness, clamp(dot(n, builder.viewer), 0.0, 1.0));
}

// alpha_x = alpha / aspect lies along the tangent turned by `rotation` full turns, alpha_y = alpha aspect across; as in
// Cycles neither is more than 1.
Microfacets anisotropic_microfacets(ClosureBuilder builder, vec3 normal, float roughness, float aspect, vec3 tangent,
                                    float rotation) {
    Microfacets made = isotropic_microfacets(builder, normal, roughness);
    if (aspect == 1.0) return made;
    vec3 across = cross(made.normal, tangent);
    if (dot(across, across) < 1e-12) return made;
    across = normalize(across);
    vec3 along = cross(across, made.normal);
    float c = cos(2.0 * PI * rotation), s = sin(2.0 * PI * rotation);
    vec3 turned = c * along + s * across;
    if (aspect > 1.0) {
        turned = cross(made.normal, turned);
        aspect = 1.0 / aspect;
    }
    if (made.alpha > aspect) made.alpha = aspect = sqrt(made.alpha * aspect);
    made.anisotropy = pack_anisotropy(made.normal, turned, aspect);
    return made;
}

MicrofacetLobe microfacet_lobe(Microfacets at, uint kind, vec3 weight, vec3 f0, vec3 tint, float ior) {
    return MicrofacetLobe(weight, kind, f0, at.alpha, tint, ior, at.packed_normal, at.anisotropy);
}

// What restores the energy that single scattering loses, given the average reflectance of the
// microfacets (Kulla and Conty 2017, with the saturation of multiple bounces).
vec3 restored_energy(float albedo, float average, vec3 average_reflectance) {
    float missing = (1.0 - albedo) / albedo;
    vec3 multiple = average_reflectance * average / (1.0 - average_reflectance * (1.0 - average));
    return 1.0 + multiple * missing;
}

// Albedo of white microfacets for the viewer, and in the mean.
vec2 white_albedos(Microfacets at) {
    float roughness = sqrt(at.alpha);
    return vec2(white_albedo(roughness, at.cosine), white_average_albedo(roughness));
}

vec3 multiscatter_factor(vec2 white, vec3 average_reflectance) {
    return restored_energy(white.x, white.y, average_reflectance);
}

MicrofacetLobe mirror_lobe(Microfacets at, vec3 weight) {
    return microfacet_lobe(at, LOBE_MIRROR, weight, vec3(1.0), vec3(1.0), 1.0);
}

void add_mirror(inout ClosureBuilder builder, Microfacets at, float weight, vec3 color, bool multiscatter) {
    vec3 factor = multiscatter ? multiscatter_factor(white_albedos(at), color) : vec3(1.0);
    add_lobe(builder, mirror_lobe(at, weight * color * factor));
}

// Of Ashikhmin and Shirley's model.
void add_phong_mirror(inout ClosureBuilder builder, Microfacets at, float weight, vec3 color) {
    add_lobe(builder, microfacet_lobe(at, LOBE_MIRROR, weight * color, vec3(1.0), vec3(0.0), 1.0));
}

// f0: at normal incidence; edge: the tint at 82 degrees; white: white_albedos.
MicrofacetLobe metal_lobe(Microfacets at, vec3 weight, vec3 f0, vec3 edge, bool multiscatter, vec2 white) {
    vec3 factor = vec3(1.0);
    if (multiscatter) {
        // Cosine-weighted mean of the Fresnel curve: 1/21 of Schlick's rise, 1/126 of the bend.
        const float far = 6.0 / 7.0, far5 = far * far * far * far * far;
        vec3 bend = mix(f0, vec3(1.0), far5) * (7.0 / (far5 * far)) * (1.0 - edge);
        factor = multiscatter_factor(white, clamp(mix(f0, vec3(1.0), 1.0 / 21.0) - bend / 126.0, 0.0, 1.0));
    }
    return microfacet_lobe(at, LOBE_METAL, weight * factor, f0, edge, 1.0);
}

float relative_ior(ClosureBuilder builder, float ior) { return builder.backfacing ? 1.0 / ior : ior; }

// tint: of the reflectance at normal incidence; repeated: of light that facets send to each other; relative: index.
MicrofacetLobe glass_lobe(Microfacets at, vec3 reflected, vec3 transmitted, vec3 tint, vec3 repeated, float relative,
                          bool multiscatter) {
    if (multiscatter) {
        float roughness = sqrt(at.alpha);
        vec3 factor = restored_energy(max(glass_albedo(relative, roughness, at.cosine), 0.05),
                                      glass_average_albedo(relative, roughness), repeated);
        reflected *= factor;
        transmitted *= factor;
    }
    return microfacet_lobe(at, LOBE_GLASS, reflected, transmitted, tint, relative);
}

// ior: of the glass, to which indices are relative where the film is seen from within. As in Cycles it seems thinner
// there, by that index. tint: of what the film reflects.
MicrofacetLobe covered_glass_lobe(ClosureBuilder builder, MicrofacetLobe lobe, Film film, float ior, vec3 tint) {
    if (film.thickness <= THINNEST_FILM) return lobe;
    lobe.weight *= tint;
    if (builder.backfacing) film.ior /= ior;
    return covered_lobe(lobe, film, false);
}

void add_refraction(inout ClosureBuilder builder, Microfacets at, vec3 weight, float ior) {
    add_lobe(builder, microfacet_lobe(at, LOBE_REFRACTION, weight, vec3(0.0), vec3(1.0), relative_ior(builder, ior)));
}

const MicrofacetLobe NO_LOBE = MicrofacetLobe(vec3(0.0), LOBE_NONE, vec3(0.0), 0.0, vec3(1.0), 1.0, 0u, ISOTROPIC);

// albedo: of the sheen, by which it hides what lies below; where that is 0 there is no lobe.
MicrofacetLobe sheen_lobe(ClosureBuilder builder, vec3 weight, float roughness, vec3 normal, out float albedo) {
    vec3 n = given_normal(builder, normal);
    vec3 parameters = sheen_parameters(clamp(roughness, 1e-3, 1.0), max(dot(n, builder.viewer), 0.0));
    albedo = 0.0;
    if (parameters.x <= 0.0 || parameters.z <= 0.0) return NO_LOBE;
    albedo = parameters.z;
    return MicrofacetLobe(weight * parameters.z, LOBE_SHEEN, vec3(parameters.xy, 0.0), 1.0, vec3(1.0), 1.0,
                          pack_unit_vector(n), ISOTROPIC);
}

MicrofacetLobe velvet_lobe(ClosureBuilder builder, vec3 weight, float sigma, vec3 normal) {
    return MicrofacetLobe(weight, LOBE_VELVET, vec3(max(sigma, 0.01), 0.0, 0.0), 1.0, vec3(1.0), 1.0,
                          pack_unit_vector(given_normal(builder, normal)), ISOTROPIC);
}

// Glossy cones are followed as microfacets that spread light as far are.
MicrofacetLobe toon_lobe(ClosureBuilder builder, uint kind, vec3 weight, float size, float fading, vec3 normal) {
    vec2 angles = clamp(vec2(size, fading), vec2(1e-3, 0.0), vec2(1.0)) * (0.5 * PI);
    float half_edge = min(0.5 * (angles.x + angles.y), 0.25 * PI), s = sin(half_edge);
    float alpha = kind == LOBE_TOON ? 1.0 : min(tan(half_edge), 1.0);
    return MicrofacetLobe(weight, kind, vec3(angles, 2.0 * s * s), alpha, vec3(1.0), 1.0,
                          pack_unit_vector(given_normal(builder, normal)), ISOTROPIC);
}
