// SPDX-License-Identifier: GPL-3.0-or-later
// The rough surface at which walks begin, as cameras see it and as light leaves by it.

#include "common/bsdf/subsurface.glsl"

// Half of the ways into skin are even.
bool is_even(Subsurface part, float u) { return part.method == SUBSURFACE_RANDOM_WALK_SKIN && u < 0.5; }

// Where a path that comes from a viewer goes on below the surface: refracted, or evenly. A null vector where it does
// not get in.
vec3 entered(Subsurface part, vec3 normal, vec3 geometric, vec3 viewer, vec3 u) {
    vec2 disk = sample_disk(u.xy);
    MicrofacetFrame frame = microfacet_frame(normal, part.alpha, ISOTROPIC);
    vec3 h = from_frame(frame, sample_visible_normal(to_frame(frame, viewer), frame.alpha, disk));
    float eta = 1.0 / part.ior, cosine = dot(h, viewer);
    bool even = is_even(part, u.z);
    vec3 direction =
        even ? cosine_hemisphere(-normal, disk)
             : (eta * cosine - sqrt(max(1.0 - eta * eta * (1.0 - cosine * cosine), 0.0))) * h - eta * viewer;
    direction = normalize(direction);
    bool inside = (even || dot(normal, viewer) > 0.0) && dot(direction, geometric) < 0.0;
    return inside ? direction : vec3(0.0);
}

// The adjoint of that: where light goes that comes to the surface from below by the direction arriving, having gone in
// by the cosine of its angle, and in weight what of it does. Viewers who look back along the way it goes see so much of
// it as their paths go in against arriving. Over the density of refracted visible normals, that of entered's leaves but
// the squared index and the ratio of the masking (Heitz 2018; Walter et al. 2007, eq. 17).
vec3 left_by(Subsurface part, vec3 normal, vec3 geometric, vec3 arriving, vec3 u, out float weight) {
    vec2 disk = sample_disk(u.xy);
    MicrofacetFrame frame = microfacet_frame(normal, part.alpha, ISOTROPIC);
    vec3 local = to_frame(frame, arriving);
    weight = min(max(local.z, 0.0) / max(dot(geometric, arriving), 1e-6), 4.0);
    if (is_even(part, u.z)) return cosine_hemisphere(geometric, disk);
    vec3 h = from_frame(frame, sample_visible_normal(local, frame.alpha, disk));
    float cosine = dot(h, arriving), k = 1.0 - part.ior * part.ior * (1.0 - cosine * cosine);
    vec3 direction = normalize(part.ior * arriving + (sqrt(max(k, 0.0)) - part.ior * cosine) * h);
    float above = dot(direction, normal), outside = dot(direction, geometric);
    bool leaves = k > 0.0 && cosine > 0.0 && above > 0.0 && outside > 0.0;
    weight *= min(outside / max(above, 1e-6), 4.0) * part.ior * part.ior * (1.0 + ggx_lambda(local, frame.alpha))
              / (1.0 + ggx_lambda(to_frame(frame, direction), frame.alpha));
    if (!leaves) weight = 0.0;
    return leaves ? direction : geometric;
}
