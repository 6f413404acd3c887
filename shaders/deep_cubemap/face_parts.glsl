// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of a ray seen through the faces: enter and leave of those along +x, +y, +z and along -x, -y, -z.
// The faces meet in six planes through the center, and neighbors take their common border from the same
// number, so that the parts leave no gap.
struct FaceParts {
    vec3 enter_positive, leave_positive, enter_negative, leave_negative;
};

FaceParts clip_to_faces(vec3 origin, vec3 direction, float from, float to) {
    // x - y, y - z, z - x and their sums
    vec3 difference = origin - origin.yzx, difference_slope = direction - direction.yzx;
    vec3 sum = origin + origin.yzx, sum_slope = direction + direction.yzx;
    vec3 difference_zero = -difference / difference_slope, sum_zero = -sum / sum_slope;
    vec3 never = vec3(INFINITY_DISTANCE), always = vec3(-INFINITY_DISTANCE);
    // from where on the difference is positive, or negative; a constant one is so always or never
    vec3 rise = mix(mix(always, difference_zero, greaterThan(difference_slope, vec3(0.0))), never,
                    bvec3(vec3(equal(difference_slope, vec3(0.0))) * vec3(lessThan(difference, vec3(0.0)))));
    vec3 fall = mix(mix(always, difference_zero, lessThan(difference_slope, vec3(0.0))), never,
                    bvec3(vec3(equal(difference_slope, vec3(0.0))) * vec3(greaterThan(difference, vec3(0.0)))));
    vec3 sum_rise = mix(mix(always, sum_zero, greaterThan(sum_slope, vec3(0.0))), never,
                        bvec3(vec3(equal(sum_slope, vec3(0.0))) * vec3(lessThan(sum, vec3(0.0)))));
    vec3 sum_fall = mix(mix(always, sum_zero, lessThan(sum_slope, vec3(0.0))), never,
                        bvec3(vec3(equal(sum_slope, vec3(0.0))) * vec3(greaterThan(sum, vec3(0.0)))));
    // until where: as long as the opposite has not begun
    vec3 rise_end = mix(never, difference_zero, lessThan(difference_slope, vec3(0.0)));
    vec3 fall_end = mix(never, difference_zero, greaterThan(difference_slope, vec3(0.0)));
    vec3 sum_rise_end = mix(never, sum_zero, lessThan(sum_slope, vec3(0.0)));
    vec3 sum_fall_end = mix(never, sum_zero, greaterThan(sum_slope, vec3(0.0)));
    FaceParts parts;
    parts.enter_positive = max(max(max(rise, fall.zxy), max(sum_rise, sum_rise.zxy)), vec3(from));
    parts.leave_positive = min(min(min(rise_end, fall_end.zxy), min(sum_rise_end, sum_rise_end.zxy)), vec3(to));
    parts.enter_negative = max(max(max(fall, rise.zxy), max(sum_fall, sum_fall.zxy)), vec3(from));
    parts.leave_negative = min(min(min(fall_end, rise_end.zxy), min(sum_fall_end, sum_fall_end.zxy)), vec3(to));
    // faces that are not seen come last
    parts.enter_positive = mix(parts.enter_positive, never, greaterThan(parts.enter_positive, parts.leave_positive));
    parts.enter_negative = mix(parts.enter_negative, never, greaterThan(parts.enter_negative, parts.leave_negative));
    return parts;
}

// Takes the face that the ray sees next out of the parts: (enter, leave); -1 if there is none.
int take_next_face(inout FaceParts parts, out vec2 part) {
    vec3 nearest = min(parts.enter_positive, parts.enter_negative);
    float enter = min(nearest.x, min(nearest.y, nearest.z));
    if (enter >= INFINITY_DISTANCE) return -1;
    int axis = nearest.x == enter ? 0 : (nearest.y == enter ? 1 : 2);
    bvec3 chosen = equal(ivec3(axis), ivec3(0, 1, 2));
    bool positive = parts.enter_positive[axis] == enter;
    part = vec2(enter, positive ? parts.leave_positive[axis] : parts.leave_negative[axis]);
    if (positive) {
        parts.enter_positive = mix(parts.enter_positive, vec3(INFINITY_DISTANCE), chosen);
    } else {
        parts.enter_negative = mix(parts.enter_negative, vec3(INFINITY_DISTANCE), chosen);
    }
    return 2 * axis + (positive ? 0 : 1);
}
