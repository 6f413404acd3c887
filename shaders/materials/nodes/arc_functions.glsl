// SPDX-License-Identifier: GPL-3.0-or-later
// Inverse trigonometry to a few float steps: drivers' own functions may be off by 1e-3 of a radian.

// The angle of (x, y), 0 at the origin. The octant's angle is that to the diagonal's half, at most 22.5 degrees,
// whose arctangent is x + x^3 p(x^2); p is fitted to 2e-8 of the angle.
float arc_tangent2(float y, float x) {
    float high = max(abs(x), abs(y)), low = min(abs(x), abs(y));
    if (high == 0.0) return 0.0;
    bool beyond = low > 0.414213562 * high;
    float t = beyond ? (low - high) / (low + high) : low / high;
    float z = t * t;
    float p = -0.33332955 + z * (0.19977924 + z * (-0.13879828 + z * 0.080602335));
    float angle = (beyond ? 0.78539816 : 0.0) + (t + t * z * p);
    if (abs(y) > abs(x)) angle = 1.57079633 - angle;
    if (x < 0.0) angle = 3.14159265 - angle;
    return y < 0.0 ? -angle : angle;
}

float arc_tangent(float a) { return arc_tangent2(a, 1.0); }
float arc_sine(float a) { return arc_tangent2(a, sqrt((1.0 - a) * (1.0 + a))); }
float arc_cosine(float a) { return arc_tangent2(sqrt((1.0 - a) * (1.0 + a)), a); }
