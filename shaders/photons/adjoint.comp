#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint:
// lint: MEDIA=1
// lint: HAIR_LOBES=1
// lint: ASHIKHMIN_LOBES=1
// lint: THIN_FILM_LOBES=1
// Photons are weighted by the BSDF as a viewer sees it who looks back along their rays: the adjoint BSDF (Veach 1997,
// section 3.7). The closures are those that such viewers see.

layout(local_size_x = 64) in;

#include "common/active_paths.glsl"
#include "common/photon.glsl"
readonly buffer Closures;
#include "photons/parts.glsl"
buffer Rays;
buffer PhotonPaths;
readonly buffer Photons;
readonly buffer AdjointQueries;
readonly buffer PhotonRange;

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
#ifdef MEDIA
    if ((photon_paths[index].flags & PATH_SCATTERED_IN_MEDIUM) != 0u) return;
#endif
    vec3 flux = photon_paths[index].flux, viewer = -rays[index].direction;
    if (!(largest(flux) > 0.0)) return;
    AdjointQuery query = adjoint_queries[index];
    if (query.part != PART_NONE) {
        vec3 arrival = photons[photon_first + active_place()].direction;
        float ior = query.part == PART_SHARP_TRANSMITTING ? 1.0 / query.ior : 1.0;
        vec3 bsdf = part_bsdf(index, closures[index], query.part, ior, viewer, arrival);
        // Channels with too small a value to be compared stay as they are.
        flux *= mix(vec3(1.0), bsdf / max(query.bsdf, 1e-20), greaterThan(query.bsdf, vec3(1e-20)));
        photon_paths[index].flux = flux;
        photon_paths[index].flags = query.flags;
    }
    rays[index].direction = viewer;
    rays[index].maximum_distance = largest(flux) > 0.0 ? query.reach : 0.0;
}
