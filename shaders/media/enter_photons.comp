#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint: TRAVERSAL=deep_cubemap/traverse.glsl MEDIA=1
// lint: TRAVERSAL=deep_cubemap/traverse.glsl TEXEL_BUFFERS=1 MEDIA=1
// lint: TRAVERSAL=bvh/traverse.glsl MEDIA=1
// lint: TRAVERSAL=bvh/traverse_two_levels.glsl MEDIA=1 HITS=media/two_levels
// lint: TRAVERSAL=deep_cubemap/traverse_two_levels.glsl TEXEL_BUFFERS=1 MEDIA=1 EMISSIVE_MEDIA=1 HITS=media/two_levels
// lint: TRAVERSAL=deep_cubemap/traverse.glsl TEXEL_BUFFERS=1 MEDIA=1 EMISSIVE_MEDIA=1
// The media that photons begin in: those at the middle of their light, and what lies on the way from there to where
// each leaves it. Emissive meshes have no middle; around suns and the world there is nothing. Photons of media that
// would begin outside of their medium are ended.

layout(local_size_x = 64) in;

#include <EnterMediaParameters>
#include "common/active_paths.glsl"
uniform Parameters { EnterMediaParameters parameters; };
readonly buffer MediaOfSources;
readonly buffer Attributes;
readonly buffer Rays;
#include "lights/light_table.glsl"
#include <Lights>
#include <LightFlags>
buffer PhotonPaths;
readonly buffer Media;
#include "media/crossings.glsl"
#ifdef EMISSIVE_MEDIA
buffer Emitted;
#include "media/emitted.glsl"

void enter_own_medium(uint index, Light light) {
    uint media;
    uint times = times_within(rays[index].origin, emissive_media[light.emissive_medium], media);
    vec3 flux = float(times) * photon_paths[index].flux;
    emitted[index].flux = photon_paths[index].flux = flux;
    photon_paths[index].flags |= media << FIRST_MEDIUM;
}
#endif

void main() {
    uint index = active_path();
    if (index == NO_PATH || !(rays[index].maximum_distance > 0.0)) return;
    uint source = light_of(index), kind = lights[source].kind;
    if (kind == LIGHT_SUN || kind == LIGHT_WORLD) return;
#ifdef EMISSIVE_MEDIA
    if (kind == LIGHT_MEDIUM) {
        enter_own_medium(index, lights[source]);
        return;
    }
#endif
    vec3 origin = rays[index].origin;
    uint media =
        kind == LIGHT_MESH ? media_at(origin) : media_beyond(lights[source].position, media_of_sources[source], origin);
    photon_paths[index].flags |= media << FIRST_MEDIUM;
}
