// SPDX-License-Identifier: GPL-3.0-or-later

// Along one image axis, the tangents between which a sphere is seen. center holds its coordinate
// along the axis and along the view; limit is the largest tangent of the view. False: not seen.
bool sphere_tangents(vec2 center, float radius, vec2 limits, out vec2 tangents) {
    float distance = length(center);
    tangents = limits;
    if (distance <= radius * 1.0001) return true;
    float middle = atan(center.x, center.y), half_angle = asin(min(radius / distance, 1.0)) + 2e-6;
    vec2 angles = atan(limits);
    float low = middle - half_angle, high = middle + half_angle;
    if (low > angles.y || high < angles.x) return false;
    tangents = vec2(low <= angles.x ? limits.x : tan(low), high >= angles.y ? limits.y : tan(high));
    return true;
}
