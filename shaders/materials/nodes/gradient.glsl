// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/constants.glsl"

#include <GradientTypes>

void node_tex_gradient(int gradient_type, vec3 vector, out vec3 color, out float fac) {
    float x = max(vector.x, 0.0);
    // Below 1, so that unit vectors give 0 however they were rounded.
    float inside = max(0.999999 - length(vector), 0.0);
    if (gradient_type == GRADIENT_LINEAR) fac = x;
    else if (gradient_type == GRADIENT_QUADRATIC) fac = x * x;
    else if (gradient_type == GRADIENT_EASING) fac = smoothstep(0.0, 1.0, x);
    else if (gradient_type == GRADIENT_DIAGONAL) fac = 0.5 * (vector.x + vector.y);
    else if (gradient_type == GRADIENT_SPHERICAL) fac = inside;
    else if (gradient_type == GRADIENT_QUADRATIC_SPHERE) fac = inside * inside;
    else fac = vector.xy == vec2(0.0) ? 0.5 : atan(vector.y, vector.x) / (2.0 * PI) + 0.5;
    fac = clamp(fac, 0.0, 1.0);
    color = vec3(fac);
}
