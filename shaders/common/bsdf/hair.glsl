// SPDX-License-Identifier: GPL-3.0-or-later
// Fibers, which scatter light all around. Of a fiber's surface a lobe keeps the normal n, from which follows how far
// from the fiber's middle it is met, and the tangent. What is scattered counts by no cosine of n.
//
// Reflection and transmission are those of Cycles' Hair BSDF: of half angles along the fiber a Cauchy distribution
// about the offset, and around it another. f0: both roughnesses and the offset; anisotropy: the tangent; tint.x: 1 on
// strands.

#include "common/bsdf/hair_chiang.glsl"
#include "common/bsdf/hair_huang.glsl"

bool lobe_is_on_strand(MicrofacetLobe lobe) {
    return lobe.kind >= LOBE_HAIR_CHIANG ? (lobe.anisotropy & HAIR_ON_STRAND) != 0u : lobe.tint.x > 0.5;
}

// Between an axis and a plane across it.
float elevation(float sine) { return asin(clamp(sine, -1.0, 1.0)); }

// Nearer than this to the tangent, radians, nothing is scattered.
const float ALONG_FIBER = 0.001;

// Of a direction to the light at the angle theta_i: the viewer's theta_o. 1/sr, but for what depends on the azimuth.
float half_angle_pdf(vec3 shape, float theta_o, float theta_i) {
    float offset = shape.z, t = 0.5 * (theta_i + theta_o) - offset;
    float high = atan((0.25 * PI + 0.5 * theta_o - offset) / shape.x),
          low = atan((0.5 * theta_o - 0.25 * PI - offset) / shape.x);
    return shape.x / (2.0 * (t * t + shape.x * shape.x) * (high - low) * cos(theta_i));
}

// phi: between the planes of viewer and light, 0 to pi.
float azimuth_pdf(uint kind, float roughness, float phi) {
    if (kind == LOBE_HAIR_REFLECTION) return 0.25 * cos(0.5 * min(phi / roughness, PI)) / roughness;
    float behind = PI - phi;
    return roughness / (2.0 * atan(0.5 * PI / roughness) * (behind * behind + roughness * roughness));
}

// As in Cycles, what reflects shows lights no more than a right angle from the viewer and above the surface, and what
// transmits those below it, though both are sampled elsewhere, too.
HairValue plain_hair_value(MicrofacetLobe lobe, vec3 n, vec3 wo, vec3 wi) {
    vec3 tangent = unpack_unit_vector(lobe.anisotropy);
    float sine_o = dot(tangent, wo), sine_i = dot(tangent, wi);
    float theta_o = elevation(sine_o), theta_i = elevation(sine_i);
    vec3 across_o = wo - sine_o * tangent, across_i = wi - sine_i * tangent;
    float cosine = dot(across_o, across_i) * inversesqrt(max(dot(across_o, across_o) * dot(across_i, across_i), 1e-20));
    bool reflects = lobe.kind == LOBE_HAIR_REFLECTION, above = dot(n, wi) >= 0.0;
    float pdf =
        half_angle_pdf(lobe.f0, theta_o, theta_i) * azimuth_pdf(lobe.kind, lobe.f0.y, acos(clamp(cosine, -1.0, 1.0)));
    if (abs(theta_i) > 0.5 * PI - ALONG_FIBER) pdf = 0.0;
    return HairValue(vec3(above != reflects || (reflects && cosine < 0.0) ? 0.0 : pdf), pdf);
}

vec3 sample_plain_hair(MicrofacetLobe lobe, vec3 wo, vec2 u, out bool scattered) {
    HairFrame frame = hair_frame(unpack_unit_vector(lobe.anisotropy), wo);
    vec3 shape = lobe.f0;
    float theta_o = elevation(dot(frame.tangent, wo));
    float high = atan((0.25 * PI + 0.5 * theta_o - shape.z) / shape.x),
          low = atan((0.5 * theta_o - 0.25 * PI - shape.z) / shape.x);
    float theta_i = 2.0 * (shape.x * tan(mix(low, high, u.x)) + shape.z) - theta_o, phi;
    if (lobe.kind == LOBE_HAIR_REFLECTION) phi = 2.0 * asin(1.0 - 2.0 * u.y) * shape.y;
    else phi = PI + shape.y * tan(2.0 * atan(0.5 * PI / shape.y) * (u.y - 0.5));
    scattered = abs(theta_i) < 0.5 * PI - ALONG_FIBER;
    return normalize(sin(theta_i) * frame.tangent + cos(theta_i) * (cos(phi) * frame.across + sin(phi) * frame.side));
}

// Elsewhere than on strands, Cycles takes the direction beside the viewer's for a bumped normal: lights that are on one
// side only of both are not seen.
bool is_hidden(MicrofacetLobe lobe, vec3 n, vec3 wo, vec3 wi) {
    vec3 side = cross(chiang_tangent(lobe), wo);
    return !lobe_is_on_strand(lobe) && dot(n, wi) * dot(n, side) * dot(side, wi) < 0.0;
}

// With the lobe's weight.
HairValue hair_value(MicrofacetLobe lobe, vec3 n, vec3 wo, vec3 wi) {
    bool hidden = lobe.kind >= LOBE_HAIR_CHIANG && is_hidden(lobe, n, wo, wi);
    if (lobe.kind == LOBE_HAIR_HUANG)
        return HairValue(hidden ? vec3(0.0) : huang_scattered(lobe, n, wo, wi), HUANG_PDF);
    HairValue value = plain_hair_value(lobe, n, wo, wi);
    if (lobe.kind == LOBE_HAIR_CHIANG) value = chiang_value(lobe, n, wo, wi);
    value.scattered *= hidden ? vec3(0.0) : lobe.weight;
    return value;
}

// Of light that paths bring, BSDF times cosine: as it is sampled.
vec3 hair_carried(MicrofacetLobe lobe, vec3 n, vec3 wo, vec3 wi) {
    return lobe.weight
           * (lobe.kind == LOBE_HAIR_CHIANG ? chiang_value(lobe, n, wo, wi).scattered
                                            : vec3(plain_hair_value(lobe, n, wo, wi).pdf));
}

// Estimate of what is not absorbed, with the lobe's weight; cosine: of the viewer to n.
vec3 hair_albedo(MicrofacetLobe lobe, float cosine) {
    if (lobe.kind == LOBE_HAIR_HUANG) return huang_albedo(lobe, cosine);
    return lobe.weight * (lobe.kind == LOBE_HAIR_CHIANG ? chiang_albedo(lobe, cosine) : vec3(1.0));
}

// Whether photons need not ask how viewers see them: light that comes to a strand leaves it all around, and means over
// the width of a fiber are the same from both sides, but for cosines.
bool hair_has_no_side(MicrofacetLobe lobe) { return lobe_is_on_strand(lobe) || lobe.kind == LOBE_HAIR_HUANG; }

// Of such photons: how much of the fiber's length is met and seen, or of the surface that it stands for.
float photon_scale(MicrofacetLobe lobe, vec3 n, vec3 wo, vec3 wi) {
    if (!hair_has_no_side(lobe)) return 1.0;
    bool plain = lobe.kind < LOBE_HAIR_CHIANG, strand = lobe_is_on_strand(lobe);
    vec3 tangent = plain ? unpack_unit_vector(lobe.anisotropy) : chiang_tangent(lobe);
    float sine_o = dot(tangent, wo), sine_i = dot(tangent, wi);
    float ratio = sqrt(max(1.0 - sine_i * sine_i, 0.0) / max(1.0 - sine_o * sine_o, 1e-6));
    float scale = plain ? ratio * ratio : ratio;
    if (lobe.kind == LOBE_HAIR_HUANG) scale = strand ? 1.0 : abs(dot(n, wi)) / max(abs(dot(n, wo)) * ratio, 1e-6);
    return min(scale, 4.0);
}

// A direction; weight: BSDF times cosine over its pdf. radiance: not of photons.
vec3 sample_hair(MicrofacetLobe lobe, vec3 n, vec3 wo, vec2 disk, float uc, bool radiance, out vec3 weight) {
    vec2 u = disk_to_square(disk);
    vec3 direction;
    if (lobe.kind == LOBE_HAIR_HUANG) direction = sample_huang(lobe, n, wo, u, uc, weight);
    else if (lobe.kind == LOBE_HAIR_CHIANG) {
        direction = sample_chiang(lobe, n, wo, u, uc);
        HairValue value = chiang_value(lobe, n, wo, direction);
        weight = lobe.weight * value.scattered / max(value.pdf, 1e-20);
    } else {
        bool scattered;
        direction = sample_plain_hair(lobe, wo, u, scattered);
        weight = scattered ? lobe.weight : vec3(0.0);
    }
    if (!radiance) weight *= photon_scale(lobe, n, wo, direction);
    return direction;
}
