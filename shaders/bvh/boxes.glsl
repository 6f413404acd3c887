// SPDX-License-Identifier: GPL-3.0-or-later
// Tests of rays with boxes.

// What a ray needs for tests with boxes.
struct SlabTest {
    vec3 low_origin;  // the ray's, less and more the margin by which all boxes are widened
    vec3 high_origin;
    vec3 inverse_direction;  // finite
};

SlabTest make_slab_test(vec3 origin, vec3 direction, float margin) {
    bvec3 moves = greaterThan(abs(direction), vec3(1e-30));
    return SlabTest(origin + margin, origin - margin, 1.0 / mix(vec3(1e-30), direction, moves));
}

// Where a ray enters a box, and whether it meets the box before a distance. Both ends give way by more than the
// rounding errors of the quotients, so that no box is missed whose triangle is hit.
bool meets_box(SlabTest slabs, vec3 low, vec3 high, float distance, out float enter) {
    vec3 a = (low - slabs.low_origin) * slabs.inverse_direction,
         b = (high - slabs.high_origin) * slabs.inverse_direction;
    vec3 near = min(a, b), far = max(a, b);
    enter = max(max(near.x, near.y), max(near.z, 0.0));
    float leave = min(min(far.x, far.y), min(far.z, distance));
    return enter * 0.999999 <= leave * 1.000001;
}
