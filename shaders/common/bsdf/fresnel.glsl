// SPDX-License-Identifier: GPL-3.0-or-later

// Unpolarised reflectance of a dielectric; eta is the index beyond over the index before.
float fresnel_dielectric(float cosine, float eta) {
    cosine = clamp(abs(cosine), 0.0, 1.0);
    float g2 = eta * eta - 1.0 + cosine * cosine;
    float g = sqrt(max(g2, 0.0));
    float a = (g - cosine) / (g + cosine);
    float b = (cosine * (g + cosine) - 1.0) / (cosine * (g - cosine) + 1.0);
    return g2 <= 0.0 ? 1.0 : 0.5 * a * a * (1.0 + b * b);
}

float normal_reflectance(float eta) {
    float root = (eta - 1.0) / (eta + 1.0);
    return root * root;
}

// Cosine-weighted mean of a dielectric's reflectance (the fit of Kulla and Conty 2017).
float average_reflectance(float eta) {
    return eta >= 1.0 ? (eta - 1.0) / (4.08567 + 1.00071 * eta)
                      : 0.997118 + eta * (0.1014 - eta * (0.965241 + 0.130607 * eta));
}

// 0 at normal incidence, where f0 is reflected, to 1 at grazing.
float interpolation_of(float reflectance, float f0) {
    return f0 >= 1.0 ? 1.0 : clamp((reflectance - f0) / (1.0 - f0), 0.0, 1.0);
}

// The same along the dielectric's curve; 0 for matching indices.
float dielectric_interpolation(float cosine, float eta) {
    return interpolation_of(fresnel_dielectric(cosine, eta), normal_reflectance(eta));
}

float schlick_interpolation(float cosine) {
    float m = clamp(1.0 - cosine, 0.0, 1.0);
    float m2 = m * m;
    return m2 * m2 * m;
}

// A dielectric whose reflectance at normal incidence, f0, is tinted and that at grazing incidence is not.
vec3 tinted_reflectance(float reflectance, float f0, vec3 tint) {
    return reflectance + (tint - 1.0) * (f0 * (1.0 - reflectance) / max(1.0 - f0, 1e-6));
}

vec3 tinted_dielectric(float cosine, float eta, vec3 tint) {
    return tinted_reflectance(fresnel_dielectric(cosine, eta), normal_reflectance(eta), tint);
}

// Schlick's Fresnel bent so that at 82 degrees (cosine 1/7) it is tinted (Kutz, Hasan and Edmondson 2021).
vec3 f82_reflectance(vec3 f0, vec3 tint, float cosine) {
    const float far = 6.0 / 7.0, far5 = far * far * far * far * far;
    vec3 bend = mix(f0, vec3(1.0), far5) * (7.0 / (far5 * far)) * (1.0 - tint);
    float m = clamp(1.0 - cosine, 0.0, 1.0);
    return clamp(mix(f0, vec3(1.0), schlick_interpolation(cosine)) - bend * cosine * m * schlick_interpolation(cosine),
                 0.0, 1.0);
}
