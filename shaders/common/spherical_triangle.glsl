// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles as seen from a point: their solid angle, and points on them evenly spread in it.

// Positive where the point lies off the triangle's plane. The edges of the triangle itself give the volume:
// those of its projection would lose digits where it is small and far.
float triangle_solid_angle(vec3 point, vec3 v0, vec3 v1, vec3 v2) {
    vec3 a = v0 - point, b = v1 - point, c = v2 - point;
    vec3 lengths = vec3(length(a), length(b), length(c));
    float volume = abs(dot(a, cross(v1 - v0, v2 - v0)));
    if (!(volume > 0.0 && min(lengths.x, min(lengths.y, lengths.z)) > 0.0)) return 0.0;
    volume = volume / lengths.x / lengths.y / lengths.z;
    a /= lengths.x;
    b /= lengths.y;
    c /= lengths.z;
    // Van Oosterom and Strackee 1983; 1 + dot(a, b) from the sum, which is exact where a and b are opposite.
    vec3 sum = a + b;
    return 2.0 * atan(volume, 0.5 * dot(sum, sum) + dot(c, sum));
}

// From the point to a place on the triangle, for u evenly spread in the triangle's solid angle, which must be
// positive. Arvo 1995 with the angles of Peters 2021 (BRDF Importance Sampling for Polygonal Lights), carried
// out in weights of the corners: whatever is rounded, the place lies on the triangle.
vec3 sample_spherical_triangle(vec3 point, vec3 v0, vec3 v1, vec3 v2, float solid_angle, vec2 u) {
    vec3 to_v0 = v0 - point, to_v1 = v1 - point, to_v2 = v2 - point;
    vec3 lengths = vec3(length(to_v0), length(to_v1), length(to_v2));
    vec3 a = to_v0 / lengths.x, b = to_v1 / lengths.y, c = to_v2 / lengths.z;
    // On the side from a to c, q cuts the fraction u.x off the solid angle. Half way from a to q is a + x (c - a).
    vec3 sum = a + b;
    float sine = sin(0.5 * u.x * solid_angle), cosine = cos(0.5 * u.x * solid_angle);
    float volume = abs(dot(to_v0, cross(v1 - v0, v2 - v0))) / lengths.x / lengths.y / lengths.z;
    float part_c = 0.5 * dot(sum, sum) * sine, part_a = max(volume * cosine - dot(c, sum) * sine, 0.0);
    float x = part_a + part_c > 0.0 ? part_c / (part_a + part_c) : 0.5 * u.x;
    vec3 half_way = mix(a, c, x);
    float stretch = 2.0 * dot(a, half_way) / max(dot(half_way, half_way), 1e-20);
    float q_a = max(stretch * (1.0 - x) - 1.0, 0.0), q_c = max(stretch * x, 0.0);
    if (q_a + q_c <= 0.0) q_a = 1.0;  // from a straight through the point to c
    vec3 q = normalize(q_a * a + q_c * c);
    // Between b and q evenly in 1 - cosine, of which q has the drop.
    float drop = min(0.5 * dot(q - b, q - b), 2.0), rise = 0.5 * dot(q + b, q + b);
    float part_q = sqrt(u.y * (2.0 - u.y * drop) / max(rise, 1e-12));
    float part_b = max(1.0 - u.y * drop - part_q * (1.0 - drop), 0.0);
    // The plane's weights are those of the directions over the distances.
    vec3 weights = vec3(part_q * q_a, part_b, part_q * q_c) / lengths;
    return (weights.x * to_v0 + weights.y * to_v1 + weights.z * to_v2) / (weights.x + weights.y + weights.z);
}
