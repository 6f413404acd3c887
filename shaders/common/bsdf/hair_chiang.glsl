// SPDX-License-Identifier: GPL-3.0-or-later
// Hair as Chiang, Bitterli, Tappan and Burley have it (A Practical and Controllable Hair and Fur Model for Production
// Path Tracing, 2016), near field, with the constants of Cycles: light that is reflected (R), passes (TT), passes
// after a reflection within (TRT), and the rest.
//
// f0: absorption over the fiber's radius; ior; tint: roughness around, along, and of the coat; anisotropy: the
// tangent's angle about n and the offset, and in the lowest bit whether it is a strand (materials/nodes/hair.glsl).

// BSDF times cosine, without the lobe's weight, and the pdf of sampling, 1/sr.
struct HairValue {
    vec3 scattered;
    float pdf;
};

// across: to the viewer, at a right angle to the tangent.
struct HairFrame {
    vec3 tangent;
    vec3 side;
    vec3 across;
};

HairFrame hair_frame(vec3 tangent, vec3 wo) {
    vec3 side = cross(tangent, wo), other;
    float length2 = dot(side, side);
    if (length2 > 1e-12) side *= inversesqrt(length2);
    else tangent_frame(tangent, side, other);
    return HairFrame(tangent, side, cross(side, tangent));
}

vec3 chiang_tangent(MicrofacetLobe lobe) {
    vec3 t, b;
    tangent_frame(unpack_unit_vector(lobe.normal), t, b);
    float angle = unpackUnorm2x16(lobe.anisotropy).x * 2.0 * PI;
    return cos(angle) * t + sin(angle) * b;
}

float hair_offset(MicrofacetLobe lobe) { return (unpackUnorm2x16(lobe.anisotropy).y - 0.5) * PI; }

float power20(float x) {
    float x4 = x * x * x * x;
    return x4 * x4 * x4 * x4 * x4;
}

// Variance along the fiber, of a roughness.
float hair_variance(float roughness) {
    float root = 0.726 * roughness + 0.812 * roughness * roughness + 3.7 * power20(roughness);
    return root * root;
}

// Of the logistic distribution around the fiber.
float hair_scale(float roughness) {
    const float root_of_pi_over_8 = 0.626657069;
    return root_of_pi_over_8
           * (0.265 * roughness + 1.194 * roughness * roughness + 5.372 * power20(roughness) * roughness * roughness);
}

// Values that follow from the viewer: the attenuations of R, TT, TRT and the rest, the probabilities with which they
// are sampled, and angles.
struct Chiang {
    HairFrame frame;
    vec3 attenuations[4];
    vec4 probabilities;
    float sine_o;
    float gamma_o;
    float gamma_t;
    float variance;
    float coat_variance;
    float scale;
};

Chiang chiang(MicrofacetLobe lobe, vec3 n, vec3 wo) {
    Chiang hair;
    hair.frame = hair_frame(chiang_tangent(lobe), wo);
    vec3 roughness = clamp(vec3(lobe.tint.xy, lobe.tint.y * lobe.tint.z), 0.001, 1.0);
    hair.scale = hair_scale(roughness.x);
    hair.variance = hair_variance(roughness.y);
    hair.coat_variance = hair_variance(roughness.z);
    hair.sine_o = clamp(dot(hair.frame.tangent, wo), -1.0, 1.0);
    float cosine_o = sqrt(1.0 - hair.sine_o * hair.sine_o), h = clamp(-dot(n, hair.frame.side), -1.0, 1.0);
    float sine_t = hair.sine_o / lobe.ior, cosine_t = sqrt(max(1.0 - sine_t * sine_t, 1e-8));
    float h_t = clamp(h * cosine_o / (lobe.ior * cosine_t), -1.0, 1.0);
    hair.gamma_o = asin(h);
    hair.gamma_t = asin(h_t);
    vec3 transmitted = exp(-lobe.f0 * (2.0 * sqrt(1.0 - h_t * h_t) / cosine_t));
    float reflected = fresnel_dielectric(cosine_o * sqrt(1.0 - h * h), lobe.ior);
    vec3 part = (1.0 - reflected) * (1.0 - reflected) * transmitted;
    hair.attenuations[0] = vec3(reflected);
    hair.attenuations[1] = part;
    hair.attenuations[2] = part * transmitted * reflected;
    hair.attenuations[3] = hair.attenuations[2] * transmitted * reflected / max(1.0 - transmitted * reflected, 1e-6);
    for (int p = 0; p < 4; ++p) hair.probabilities[p] = luminance(hair.attenuations[p]);
    hair.probabilities /=
        max(hair.probabilities.x + hair.probabilities.y + hair.probabilities.z + hair.probabilities.w, 1e-20);
    return hair;
}

// The lobe's variance along the fiber.
float lobe_variance(Chiang hair, int p) {
    return p == 0 ? hair.coat_variance : p == 1 ? 0.25 * hair.variance : 4.0 * hair.variance;
}

// Sine and cosine of the viewer's angle to the plane across the fiber, turned by how far scales tilt a lobe.
vec2 tilted_viewer(int p, float offset, float sine) {
    vec2 theta = vec2(sine, sqrt(max(1.0 - sine * sine, 0.0)));
    float turn = p == 0 ? 2.0 * offset : p == 1 ? -offset : p == 2 ? -4.0 * offset : 0.0;
    float s = sin(turn), c = cos(turn);
    return vec2(theta.x * c + theta.y * s, abs(theta.y * c - theta.x * s));
}

float bessel_i0(float x) {
    float sum = 1.0, term = 1.0, quarter = 0.25 * x * x;
    for (int i = 1; i < 10; ++i) {
        term *= quarter / float(i * i);
        sum += term;
    }
    return sum;
}

float log_bessel_i0(float x) { return x > 12.0 ? x + 0.5 * (1.0 / (8.0 * x) - log(2.0 * PI * x)) : log(bessel_i0(x)); }

// Sines and cosines of the angles of light and viewer.
float longitudinal_pdf(vec2 i, vec2 o, float variance) {
    float inverse = 1.0 / variance, cosines = i.y * o.y * inverse, sines = i.x * o.x * inverse;
    if (variance <= 0.1) return exp(log_bessel_i0(cosines) - sines - inverse + 0.6931 + log(0.5 * inverse));
    return exp(-sines) * bessel_i0(cosines) / (sinh(inverse) * 2.0 * variance);
}

// Fraction of the logistic distribution below -pi.
float logistic_tail(float scale) { return 1.0 / (1.0 + exp(min(PI / scale, 80.0))); }

// By which angle around the fiber light leaves that is not scattered by roughness.
float exit_azimuth(int p, Chiang hair) { return 2.0 * float(p) * hair.gamma_t - 2.0 * hair.gamma_o + float(p) * PI; }

float azimuthal_pdf(int p, Chiang hair, float phi) {
    if (p == 3) return 0.5 / PI;
    float x = phi - exit_azimuth(p, hair);
    x -= 2.0 * PI * floor((x + PI) / (2.0 * PI));
    float e = exp(-abs(x) / hair.scale);
    return e / (hair.scale * (1.0 + e) * (1.0 + e) * (1.0 - 2.0 * logistic_tail(hair.scale)));
}

HairValue chiang_value(MicrofacetLobe lobe, vec3 n, vec3 wo, vec3 wi) {
    Chiang hair = chiang(lobe, n, wo);
    float offset = hair_offset(lobe);
    float sine_i = clamp(dot(hair.frame.tangent, wi), -1.0, 1.0);
    vec2 theta = vec2(sine_i, sqrt(1.0 - sine_i * sine_i));
    float phi = atan(-dot(wi, hair.frame.across), dot(wi, hair.frame.side)) + 0.5 * PI;
    HairValue value = HairValue(vec3(0.0), 0.0);
    for (int p = 0; p < 4; ++p) {
        vec2 viewer = tilted_viewer(p, offset, hair.sine_o);
        float pdf = longitudinal_pdf(theta, viewer, lobe_variance(hair, p)) * azimuthal_pdf(p, hair, phi);
        value.scattered += hair.attenuations[p] * pdf;
        value.pdf += hair.probabilities[p] * pdf;
    }
    return value;
}

// uc chooses the lobe, and what is left of it an angle.
vec3 sample_chiang(MicrofacetLobe lobe, vec3 n, vec3 wo, vec2 u, float uc) {
    Chiang hair = chiang(lobe, n, wo);
    int p = 0;
    while (p < 3 && uc >= hair.probabilities[p]) uc -= hair.probabilities[p++];
    float variance = lobe_variance(hair, p);
    float w = clamp(uc / max(hair.probabilities[p], 1e-20), 1e-5, 1.0);
    float along = clamp(1.0 + variance * log(w + (1.0 - w) * exp(-2.0 / variance)), -1.0, 1.0);
    vec2 viewer = tilted_viewer(p, hair_offset(lobe), hair.sine_o);
    float sine = clamp(sqrt(1.0 - along * along) * cos(2.0 * PI * u.y) * viewer.y - along * viewer.x, -1.0, 1.0);
    float phi = 2.0 * PI * u.x;
    if (p < 3) {
        float tail = logistic_tail(hair.scale), x = mix(tail, 1.0 - tail, u.x);
        phi = exit_azimuth(p, hair) - hair.scale * log(max(1.0 - x, 1e-30) / max(x, 1e-30));
    }
    phi -= 0.5 * PI;
    return normalize(sine * hair.frame.tangent
                     + sqrt(1.0 - sine * sine) * (cos(phi) * hair.frame.side - sin(phi) * hair.frame.across));
}

// Of a fiber that is looked at across.
vec3 chiang_albedo(MicrofacetLobe lobe, float cosine) {
    float sine2 = (1.0 - cosine * cosine) / (lobe.ior * lobe.ior);
    vec3 transmitted = exp(-lobe.f0 * (2.0 * sqrt(max(1.0 - sine2, 0.0))));
    float reflected = fresnel_dielectric(cosine, lobe.ior);
    return reflected + (1.0 - reflected) * (1.0 - reflected) * transmitted / max(1.0 - transmitted * reflected, 1e-6);
}
