// SPDX-License-Identifier: GPL-3.0-or-later
// Toon shading: bright within a cone about an axis, the normal or the mirrored direction of the viewer, and dark
// outside, as Cycles has it. shape: the angle up to which all is scattered, that over which it fades from there, and
// what the cosine of the edge, at a right angle at most, lacks to 1.

#include "common/sampling.glsl"

float toon_intensity(vec3 shape, float cosine) {
    if (cosine <= 0.0) return 0.0;
    float beyond = acos(min(cosine, 1.0)) - shape.x;
    return beyond < 0.0 ? 1.0 : clamp(1.0 - beyond / max(shape.y, 1e-6), 0.0, 1.0);
}

// Uniform within the cone, 1/sr, which times the intensity is BSDF times cosine of wi.
float toon_pdf(vec3 shape) { return 1.0 / (2.0 * PI * shape.z); }

// d: of the unit disk.
vec3 sample_toon(vec3 shape, vec3 axis, vec2 d) {
    vec3 t, b;
    tangent_frame(axis, t, b);
    float drop = dot(d, d) * shape.z;
    d *= sqrt(shape.z * (2.0 - drop));
    return normalize(d.x * t + d.y * b + (1.0 - drop) * axis);
}
