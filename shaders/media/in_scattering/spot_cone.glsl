// SPDX-License-Identifier: GPL-3.0-or-later
// The part of a ray that a spot light lights. The includer includes lights/lights.glsl before.

// Distances along a ray between which it is within the cone that holds all light of a spot light, also of one with a
// radius; false where none are.
bool within_spot_cone(Light light, vec3 origin, vec3 direction, float far, out vec2 range) {
    range = vec2(0.0, far);
    float cosine = 1.0 - light.spread_scale;
    if (cosine < 0.05) return true;
    // The cone touches the sphere of the light from within it.
    vec3 from_apex =
        origin - light.position + light.radius * inversesqrt(max(1.0 - cosine * cosine, 1e-8)) * light.normal;
    float c2 = cosine * cosine * (1.0 - 1e-4), along = dot(direction, light.normal),
          height = dot(from_apex, light.normal);
    float quadratic = along * along - c2, linear = along * height - c2 * dot(direction, from_apex),
          constant = height * height - c2 * dot(from_apex, from_apex),
          discriminant = linear * linear - quadratic * constant;
    if (abs(quadratic) < 1e-6) return true;
    // Steep rays are within beyond one end, others between both; half of the double cone lies behind the light.
    if (quadratic > 0.0) {
        float root = sqrt(max(discriminant, 0.0)) / quadratic, middle = -linear / quadratic;
        if (along > 0.0) range.x = max(middle + root, 0.0);
        else range.y = min(middle - root, far);
        return range.x < range.y;
    }
    if (discriminant <= 0.0) return false;
    float middle = linear / -quadratic, root = sqrt(discriminant) / -quadratic;
    if (height + along * middle <= 0.0) return false;
    range = vec2(max(middle - root, 0.0), min(middle + root, far));
    return range.x < range.y;
}
