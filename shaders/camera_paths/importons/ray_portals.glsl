// SPDX-License-Identifier: GPL-3.0-or-later
// Ray portals, by which a camera path goes on elsewhere. As in Cycles a path behind one is what it was before, counts
// one more transparent surface, and alone finds the light there: neither shadow rays nor photons come through.
// The includer includes camera_paths/importons/path_vertex.glsl before.

#include "common/bsdf/ray_portal.glsl"

// Whether the sampled ray leaves by a ray portal.
bool by_ray_portal = false;

RayPortal ray_portal_at(SurfaceVertex vertex) {
    return unpacked_ray_portal(closures[vertex.index].lobes[CLOSURE_LOBES - 1]);
}

BsdfSample sample_ray_portal(SurfaceVertex vertex) {
    CameraPath path = vertex.path;
    RayPortal portal = ray_portal_at(vertex);
    by_ray_portal = true;
    uint flags = (path.flags & ~(PATH_LIGHTS_FOUND | PATH_SEEN_THROUGH)) | PATH_CAUSTIC;
    return BsdfSample(portal.direction, portal.weight, portal.direction, largest(path.throughput * portal.weight), true,
                      0.0, flags, SCATTER_NONE, vec3(1.0));
}

// before: the path's lit_from as it came. Behind a ray portal no shadow rays sample what the path finds.
void note_ray_portals(inout CameraPath path, uint before) {
    path.lit_from |= before & ~(LIT_FROM_BITS - 1u);
    if (by_ray_portal) {
        path.straight_length = 0.0;
        path.lit_from += ONE_RAY_PORTAL;
        if (is_final_gather(path)) path.lit_from |= BEHIND_RAY_PORTAL;
    }
    if (is_behind_ray_portal(path)) path.scatter_pdf = 0.0;
}

// The ray behind a ray portal. It may meet the very triangle that it comes from, unless it goes on in place.
Ray ray_behind_portal(SurfaceVertex vertex, vec3 in_place, vec3 direction) {
    RayPortal portal = ray_portal_at(vertex);
    return Ray(portal.moves ? portal.position : in_place, portal.moves ? NO_TRIANGLE : vertex.closure.triangle,
               direction, INFINITY_DISTANCE);
}
