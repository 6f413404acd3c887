#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// DirectSplatting: where on the camera's band each stored photon may contribute (Fig. 6b).

layout(local_size_x = 64) in;

#include <SplatParameters>
#include "common/iteration.glsl"
#include "common/invocation.glsl"
#include "common/photon.glsl"
#include "camera_paths/gbuffer/projections.glsl"
#include "density_estimation/splatting/sphere_bounds.glsl"
#include "density_estimation/splatting/jobs.glsl"
uniform Parameters { SplatParameters parameters; };
readonly buffer Photons;
readonly buffer StoredPhotons;
readonly buffer Camera;
buffer Jobs;

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    uint number = stored_photons[index];
    if (parameters.gathers != 0u && (photons[number].flags & PHOTON_INDIRECT) != 0u) return;
    vec3 offset = photons[number].position - camera.position;
    vec3 p = vec3(dot(offset, camera.right), dot(offset, camera.up), dot(offset, camera.forward));
    float radius =
        photon_radius(photons[number].flags, parameters.minimum_radius, parameters.radius, iteration.wide_radius);
    if (p.z < -radius) return;
    vec2 across = vec2(p.x - radius, p.x + radius), along = vec2(p.y - radius, p.y + radius);
    if (camera.projection != PROJECTION_ORTHOGRAPHIC) {
        if (!sphere_tangents(p.xz, radius, camera.window.xy, across)) return;
        if (!sphere_tangents(p.yz, radius, camera.window.zw, along)) return;
    }
    vec2 size = vec2(camera.width, camera.height), extent = camera.window.yw - camera.window.xz;
    vec2 low = (vec2(across.x, along.x) - camera.window.xz) / extent * size - 1e-2;
    vec2 high = (vec2(across.y, along.y) - camera.window.xz) / extent * size + 1e-2;
    uvec2 first = uvec2(clamp(floor(low), vec2(0.0), size)), last = uvec2(clamp(ceil(high), vec2(0.0), size));
    if (first.x >= last.x || first.y >= last.y) return;
    uint job = atomicAdd(job_vertices, 6u) / 6u;
    jobs[job] = SplatJob(number, first.x | (first.y << 16u), last.x | (last.y << 16u), 0u);
}
