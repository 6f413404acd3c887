// SPDX-License-Identifier: GPL-3.0-or-later
// Coordinates within the segments of a regular polygon with rounded corners, as Cycles has them. Angles are counted
// from a corner; the lengths of all polygons are those of the circle within. With a fraction of a side, the last
// segment is narrower, and its corners are rounded by circles that touch both sides.

#include "common/constants.glsl"

// Half of a side: the angle up to which it is rounded and the rest, and of the coordinate along it at a distance of 1
// what is bent into a curve, and what is an arc.
struct RoundedHalf {
    float bevel;
    float straight;
    float curved;
    float arc;
};

RoundedHalf rounded_half(float angle, float bevel, float roundness) {
    return RoundedHalf(bevel, angle - bevel, (1.0 - roundness) * bevel, roundness * bevel);
}

float bevel_of(float angle, float roundness) {
    return roundness > 0.0 ? angle - atan((1.0 - roundness) * tan(angle)) : 0.0;
}

// The coordinate at the corner.
float largest_parameter(RoundedHalf side, float distance) {
    return distance * tan(side.straight) + 0.5 * side.curved * (distance + 1.0) + side.arc;
}

// distance: to the center; beyond: the angle past the bevel.
float rounded_parameter(RoundedHalf side, float distance, float beyond) {
    float height = distance * cos(side.straight);
    float bent = beyond < side.curved ? height * beyond + 0.5 * (1.0 - height) * beyond * beyond / side.curved
                                      : 0.5 * side.curved * (height - 1.0) + beyond;
    return distance * sin(side.straight) + bent;
}

// rise: of the polygon through the place.
float largest_rounded_parameter(RoundedHalf side, float distance, float rise, float beyond) {
    return mix(largest_parameter(side, rise), largest_parameter(side, distance * cos(side.straight)),
               beyond / side.bevel);
}

// How far a circle is from the center in a direction.
float distance_to_circle(vec2 center, float radius, vec2 direction) {
    float along = dot(center, direction);
    return along + sqrt(max(along * along + radius * radius - dot(center, center), 0.0));
}

// Where a place is in its segment: distance of the polygon through it, coordinate along the side without sign, its
// largest value, width of the segment, and the angle of the side's middle in it.
struct SegmentPlace {
    float rise;
    float parameter;
    float largest;
    float width;
    float middle;
};

SegmentPlace on_side(RoundedHalf side, float angle, float middle, float distance, float width) {
    float rise = distance * cos(middle - angle);
    return SegmentPlace(rise, distance * sin(abs(middle - angle)), largest_parameter(side, rise), width, middle);
}

SegmentPlace in_corner(RoundedHalf side, float angle, float middle, float distance, float roundness, float width) {
    float from_corner = min(angle, 2.0 * middle - angle), beyond = side.bevel - from_corner;
    vec2 center = vec2((1.0 - roundness) / cos(middle), 0.0);
    float rise = distance / distance_to_circle(center, roundness, vec2(cos(from_corner), sin(from_corner)));
    return SegmentPlace(rise, rounded_parameter(side, distance, beyond),
                        largest_rounded_parameter(side, distance, rise, beyond), width, middle);
}

// In the narrow segment, whose half is `last`, and around its corners. turn: -pi to pi; x: the same from 0 on; bevel:
// of the narrow side; outer: of those beside it; circle: center and radius.
SegmentPlace near_narrow_side(RoundedHalf inner, RoundedHalf outer, vec3 circle, float angle, float middle, float last,
                              float turn, float x, float distance, float width) {
    float ratio = cos(middle) / cos(last);
    float narrow_width = tan(inner.straight) + 0.5 * inner.curved + ratio * (0.5 * inner.curved + inner.arc);
    SegmentPlace place;
    if (x >= 2.0 * (PI - last) + inner.bevel && x < 2.0 * PI - inner.bevel) {
        place = on_side(inner, angle, last, distance, narrow_width);
    } else {
        if (x >= 2.0 * (PI - last) - outer.bevel && x < 2.0 * PI - last) turn = -(turn + 2.0 * last);
        float rise = distance / distance_to_circle(circle.xy, circle.z, vec2(cos(turn), sin(turn)));
        bool within = turn < 0.0;
        RoundedHalf side = outer;
        if (within) side = inner;
        float beyond = side.bevel - abs(turn), risen = within ? rise : ratio * rise;
        place = SegmentPlace(risen, rounded_parameter(side, distance, beyond),
                             largest_rounded_parameter(side, distance, risen, beyond), within ? narrow_width : width,
                             within ? last : middle);
        if (!within) return place;
    }
    place.rise *= ratio;
    place.parameter *= ratio;
    place.largest *= ratio;
    return place;
}

SegmentPlace segment_place(float sides, float roundness, float turn, float x, float angle, float distance) {
    float middle = PI / sides, last = PI - floor(sides) * middle;
    bool irregular = fract(sides) != 0.0;
    RoundedHalf side = rounded_half(middle, bevel_of(middle, roundness), roundness), outer = side;
    float width = largest_parameter(side, 1.0), end = 2.0 * (PI - last);
    bool straight = angle >= side.bevel && angle < 2.0 * middle - side.bevel;
    if (irregular) {
        RoundedHalf inner = rounded_half(last, bevel_of(last, roundness), roundness);
        float radius = roundness * tan(last) / tan(0.5 * (middle + last));
        vec2 start = vec2(cos(inner.bevel), -sin(inner.bevel)) / cos(inner.straight);
        vec2 center = start - radius * vec2(cos(last), -sin(last));
        vec2 touched = center + radius * vec2(cos(middle), sin(middle));
        float bevel = atan(touched.y / touched.x);
        outer = rounded_half(middle, bevel, 1.0 - tan(middle - bevel) / tan(middle));
        if (x < bevel || x >= end - bevel)
            return near_narrow_side(inner, outer, vec3(center, radius), angle, middle, last, turn, x, distance, width);
        straight = straight || x < side.bevel || x >= end - side.bevel;
    }
    if (!straight) return in_corner(side, angle, middle, distance, roundness, width);
    if (irregular && (x < middle || x >= end - middle)) side = outer;
    SegmentPlace place = on_side(side, angle, middle, distance, width);
    if (sides == 2.0 && roundness == 0.0) place.largest = 1.0, place.width = 0.0;
    return place;
}

void node_radial_tiling(int normalized, vec3 vector, float sides, float roundness, out vec3 segment_coordinates,
                        out float segment_id, out float segment_width, out float segment_rotation) {
    sides = max(sides, 2.0);
    bool centered = vector.xy == vec2(0.0);
    float turn = centered ? 0.0 : atan(vector.y, vector.x), below = vector.y < 0.0 ? 1.0 : 0.0;
    float x = turn + 2.0 * PI * below, segment = 2.0 * PI / sides, number = floor(x / segment);
    float angle = x - number * segment;
    SegmentPlace place = segment_place(sides, clamp(roundness, 0.0, 1.0), turn, x, angle, length(vector.xy));
    float parameter = centered ? 0.0 : angle < place.middle ? -place.parameter : place.parameter;
    segment_coordinates = vec3(parameter, place.rise - 1.0, 0.0);
    if (normalized != 0)
        segment_coordinates = vec3(centered ? 0.5 : 0.5 * parameter / place.largest + 0.5, place.rise, 0.0);
    segment_id = floor(sides * (turn / (2.0 * PI) + below));
    segment_width = place.width;
    segment_rotation = number * segment + place.middle;
}
