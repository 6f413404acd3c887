// SPDX-License-Identifier: GPL-3.0-or-later
// The rectangle that a triangle may touch on a face.
#include "deep_cubemap/cone_bounds.glsl"
#include "deep_cubemap/extents.glsl"

// Nearer than this many margins, dividing by the depth no longer says where a point is.
const float MIN_MARGINS = 16.0;

// The triangle's extent on a face; false if it is not seen through this face.
bool face_extent(vec3 a, vec3 b, vec3 c, float margin, out uvec2 packed_extent) {
    float near = MIN_MARGINS * margin;
    vec4 extent;
    if (!cone_extent(a, b, c, vec4(-1.0, 1.0, -1.0, 1.0), margin, near, near, extent)) return false;
    extent = extent * 0.5 + 0.5;
    if (any(lessThan(extent.zw, vec2(-1e-5))) || any(greaterThan(extent.xy, vec2(1.0 + 1e-5)))) return false;
    packed_extent = pack_extent(extent.xy, extent.zw);
    return true;
}
