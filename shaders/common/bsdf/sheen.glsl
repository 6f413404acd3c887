// SPDX-License-Identifier: GPL-3.0-or-later
// Sheen of fibers: a linearly transformed cosine (Zeltner, Burley and Chiang 2022), and Ashikhmin's velvet
// (Ashikhmin and Premoze 2007). Both in a frame with z along the normal and wo in the plane of x and z.

#include "common/sampling.glsl"

struct SheenFrame {
    vec3 t;
    vec3 b;
    vec3 n;
};

SheenFrame sheen_frame(vec3 n, vec3 wo) {
    vec3 t, b;
    tangent_frame(n, t, b);
    vec3 along = wo - dot(wo, n) * n;
    if (dot(along, along) > 1e-12) {
        t = normalize(along);
        b = cross(n, t);
    }
    return SheenFrame(t, b, n);
}

// coefficients a and b: the direction (a x + b z, a y, z) is distributed by the cosine. 1/sr; z is wi's cosine.
float sheen_pdf(vec2 coefficients, vec3 n, vec3 wo, vec3 wi) {
    float a = coefficients.x, b = coefficients.y, z = max(dot(wi, n), 0.0), cosine_o = dot(wo, n);
    float x = (dot(wo, wi) - cosine_o * z) * inversesqrt(max(1.0 - cosine_o * cosine_o, 1e-12));
    float ratio = a / max(a * a * (1.0 - z * z) + 2.0 * a * b * x * z + (b * b + 1.0) * z * z, 1e-20);
    return z * ratio * ratio / PI;
}

// d: of the unit disk.
vec3 sample_sheen(vec2 coefficients, SheenFrame frame, vec2 d) {
    float z = sqrt(max(0.0, 1.0 - dot(d, d)));
    vec3 w = vec3(d.x - coefficients.y * z, d.y, z * coefficients.x);
    return normalize(w.x * frame.t + w.y * frame.b + w.z * frame.n);
}

// BSDF times cosine of wi.
float velvet_scattered(float sigma, vec3 n, vec3 wo, vec3 wi) {
    float cosine_o = dot(n, wo), cosine_i = dot(n, wi);
    vec3 h = normalize(wo + wi);
    float nh = dot(n, h), oh = abs(dot(wo, h));
    if (cosine_o <= 1e-5 || cosine_i <= 0.0 || oh < 1e-5 || nh > 0.99999) return 0.0;
    float sine2 = 1.0 - nh * nh, inverse = 1.0 / (sigma * sigma);
    float density = exp(-nh * nh / sine2 * inverse) * inverse / (PI * sine2 * sine2);
    float shadowing = min(1.0, 2.0 * max(nh / oh, 1e-5) * min(cosine_o, cosine_i));
    return 0.25 * density * shadowing / cosine_o;
}
