// SPDX-License-Identifier: GPL-3.0-or-later
// Where camera paths begin a final gather. The includer includes common/bsdf/closure.glsl and lights/light_tree.glsl
// before.

#include "common/iteration.glsl"
#include "common/camera_path.glsl"
#include "common/path_depth.glsl"

bool is_final_gather(CameraPath path) { return (path.flags & PATH_FINAL_GATHER) != 0u; }

bool is_secondary_gather(CameraPath path) {
    const uint both = PATH_FINAL_GATHER | PATH_SECONDARY_GATHER;
    return (path.flags & both) == both;
}

#ifdef MEDIA
#include "media/medium_gather.glsl"
#else
bool is_medium_gather(CameraPath path) { return false; }
#endif

// Whether a path may begin a final gather at a closure, or a secondary one. The first begins anywhere. In corners, near
// the origin of a ray, the disk in which photons count reaches beyond the surface, to where there are no photons: there
// a secondary one begins. Strands and points are too small for such disks, so that it begins on all of them. Nor do
// photons bring the light that comes through ray portals: in scenes with such it begins everywhere.
bool can_gather(CameraPath path, Closure closure) {
    if (iteration.final_gather == 0u || bounces_of(path.depth) >= iteration.camera_bounces) return false;
    if (!is_final_gather(path)) return true;
#ifdef RAY_PORTALS
    return true;
#endif
    bool is_round = iteration.has_round_shapes != 0u && is_one_sided(triangle_vertices[3u * closure.triangle].w);
    bool is_corner = closure.distance < iteration.gathers_again_below;
    return (path.flags & PATH_CAUSTIC) == 0u && (is_round || is_corner);
}
