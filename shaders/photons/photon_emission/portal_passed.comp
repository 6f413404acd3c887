#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint: PORTALS=1
// Direct light of the world that comes through a portal is left to shadow rays, which find it there better than photons
// bring it (direct_photon_mis_weight): such photons are marked by a pdf of shadow rays that leaves nothing to photons.

layout(local_size_x = 64) in;

#include <PhotonFlags>
#include "common/active_paths.glsl"
#include "lights/lights.glsl"
readonly buffer Rays;
readonly buffer Hits;
readonly buffer PhotonPaths;
buffer PhotonOrigins;

void main() {
    uint index = active_path();
    if (index == NO_PATH || (photon_paths[index].flags & PHOTON_DIRECT) == 0u) return;
    if (lights[light_of(index)].kind != LIGHT_WORLD) return;
    Ray ray = rays[index];
    Hit hit = hits[index];
    if (!(ray.maximum_distance > 0.0) || hit.triangle == NO_TRIANGLE) return;
    if (view_portals(ray.origin + hit.distance * ray.direction, -ray.direction, NO_PORTAL).pdf > 0.0)
        photon_origins[index].pdf = ONLY_SHADOW_RAYS;
}
