#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint:
// lint: MEDIA=1
// lint: MEDIA=1 HETEROGENEOUS_MEDIA=1
// lint: HAIR_LOBES=1
// lint: ASHIKHMIN_LOBES=1
// lint: THIN_FILM_LOBES=1
// lint: COUNTS_BOUNCES=1 DROPS_CAUSTICS=1
// TracePhotons: at the end of the ray of a photon path, store the photon and sample the next ray.

layout(local_size_x = 64) in;

#include <ScatterPhotonsParameters>
#include "common/iteration.glsl"
#include "common/active_paths.glsl"
#include "common/photon.glsl"
uniform Parameters { ScatterPhotonsParameters parameters; };
readonly buffer Closures;
#include "photons/parts.glsl"
readonly buffer Materials;
readonly buffer Media;
#include "materials/medium.glsl"
buffer Rays;
buffer PhotonPaths;
writeonly buffer Photons;
writeonly buffer AdjointQueries;
readonly buffer PhotonRange;
#include "photons/photon_vertex.glsl"
#include "photons/sample_bsdf.glsl"
#include "photons/sample_next_ray.glsl"

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    PhotonPath path = photon_paths[index];
#ifdef MEDIA
    if ((path.flags & PATH_SCATTERED_IN_MEDIUM) != 0u) return;
#endif
    Ray ray = rays[index];
    // The path ends here unless it gets a next ray.
    rays[index].maximum_distance = 0.0;
    photon_paths[index].flux = vec3(0.0);
    if (!has_flux(path.flux)) {
        write_ended_path(index, path, ray);
        return;
    }
    if (!closure_hit(closures[index])) {
        handle_escaped(index, path, ray);
        return;
    }
    PhotonVertex vertex = photon_vertex(index, path, ray);
    store_photon(vertex);
    if (!has_flux(vertex.flux)) return;
    if (limit_bounces(vertex.closure, vertex.depth)) sample_next_ray(vertex);
    else photon_paths[index].deposited = channel_sum(path.flux);
}
