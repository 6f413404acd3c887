// SPDX-License-Identifier: GPL-3.0-or-later
// What a camera path remembers of where shadow rays looked for the lights that its ray may meet. The includer includes
// lights/light_tree.glsl before.
#include "common/path_depth.glsl"

// In a path's lit_from: the light set, and flags above it.
const uint LIT_FROM_BEHIND = 64u, LIT_WHERE_GATHERED = 128u;

uint pack_lit_from(uint light_set, bool from_behind, bool gathers) {
    return light_set | (from_behind ? LIT_FROM_BEHIND : 0u) | (gathers ? LIT_WHERE_GATHERED : 0u);
}

// Whether a path finds lights. Gathering rays share them with shadow rays, until something scatters them; what others
// send to a second gathering vertex is left to shadow rays.
bool path_sees_lights(CameraPath path, uint next_event) {
    bool is_direct = (path.flags & (PATH_CAUSTIC | PATH_GATHERED_AGAIN)) == 0u;
    return (path.flags & PATH_GATHERED) == 0u || (is_direct && next_event != 0u && path.scatter_pdf > 0.0);
}

// start: where the ray was scattered (scattered_at).
ScatterPoint scatter_point(CameraPath path, Ray ray, vec3 start) {
    LitPoint lit = LitPoint(start, vec3(0.0), false, light_set_at(ray.source_triangle));
    bool gathers = (path.flags & PATH_GATHERED) != 0u;
    uint bounces = bounces_of(path.depth);
    ScatterPoint from = ScatterPoint(lit, 0.0, path.scatter_pdf, gathers, gathers ? bounces - 1u : bounces);
    if (path.scatter_pdf > 0.0) {
        from.lit.normal = unpack_unit_vector(path.lit_normal);
        from.lit.both_sides = (path.lit_from & LIT_FROM_BEHIND) != 0u;
        from.lit.light_set = path.lit_from & (LIT_FROM_BEHIND - 1u);
        from.environment_irradiance = chosen_environment_irradiance(start, (path.lit_from & LIT_WHERE_GATHERED) != 0u);
    }
    return from;
}
