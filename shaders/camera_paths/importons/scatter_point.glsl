// SPDX-License-Identifier: GPL-3.0-or-later
// The vertex from which a ray of a camera path left, as the MIS weights of lights that the ray meets need it: shadow
// rays from there sample the same lights. The includer includes lights/light_tree.glsl and declares the blocks
// FinalGatherOrigins and FinalGatherHits before.

#include "common/iteration.glsl"
#include "common/path_depth.glsl"
#include "camera_paths/importons/final_gather.glsl"
#include "camera_paths/importons/clear_glass.glsl"

// A path's lit_from is a light set, with flags above it, and in scenes with ray portals the number of those passed.
const uint LIT_FROM_BEHIND = 64u, LIT_GATHER_ORIGIN = 128u;

// Whether a path of a final gather has come through a ray portal since its ray left: shadow rays and photons bring
// nothing of what it finds.
bool is_behind_ray_portal(CameraPath path) {
#ifdef RAY_PORTALS
    return (path.lit_from & BEHIND_RAY_PORTAL) != 0u;
#else
    return false;
#endif
}

uint pack_lit_from(uint light_set, bool from_behind, bool is_gather_origin) {
    return light_set | (from_behind ? LIT_FROM_BEHIND : 0u) | (is_gather_origin ? LIT_GATHER_ORIGIN : 0u);
}

// Whether a path adds the emission that it meets. The ray of a final gather does so until something scatters it, with
// an MIS weight, since shadow rays find the same lights. Without them, and behind a secondary gather, it does not.
bool path_collects_emission(CameraPath path) {
    bool is_direct = (path.flags & PATH_CAUSTIC) == 0u && !is_secondary_gather(path);
    return !is_final_gather(path) || is_behind_ray_portal(path)
           || (is_direct && !is_medium_gather(path) && iteration.next_event != 0u && path.scatter_pdf > 0.0);
}

// The vertex at which a path was scattered last. A ray that passes a surface begins anew behind it, while shadow rays
// from that vertex pass some surfaces unhindered.
vec3 scatter_position(uint index, CameraPath path, Ray ray) {
    if ((path.flags & PATH_SEEN_THROUGH) == 0u) return ray.origin;
    // A third gather begins within iteration.gathers_again_below of the vertex of the second one, which stands for it.
    return is_secondary_gather(path) ? final_gather_hits[index].position : final_gather_origins[index].position;
}

ScatterPoint scatter_point(uint index, CameraPath path, Ray ray) {
    vec3 position = scatter_position(index, path, ray);
    LitPoint lit = LitPoint(position, vec3(0.0), false, light_set_at(ray.source_triangle));
    bool gathers = is_final_gather(path) && !is_behind_ray_portal(path);
    uint bounces = bounces_of(path.depth);
    ScatterPoint from = ScatterPoint(lit, 0.0, path.scatter_pdf, gathers, gathers ? bounces - 1u : bounces);
    if (path.scatter_pdf > 0.0) {
        from.lit.normal = unpack_unit_vector(path.lit_normal);
        from.lit.both_sides = (path.lit_from & LIT_FROM_BEHIND) != 0u;
        from.lit.light_set = path.lit_from & (LIT_FROM_BEHIND - 1u);
        from.environment_irradiance =
            chosen_environment_irradiance(position, (path.lit_from & LIT_GATHER_ORIGIN) != 0u);
    }
    return from;
}
