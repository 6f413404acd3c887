#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint: TRAVERSAL=deep_cubemap/traverse.glsl MEDIA=1
// lint: TRAVERSAL=deep_cubemap/traverse.glsl TEXEL_BUFFERS=1 MEDIA=1
// lint: TRAVERSAL=bvh/traverse.glsl MEDIA=1
// lint: TRAVERSAL=bvh/traverse_two_levels.glsl MEDIA=1
// lint: TRAVERSAL=deep_cubemap/traverse_two_levels.glsl MEDIA=1
// The media that photons begin in: those at the middle of their light, and what lies on the way from there to where
// each leaves it. Emissive meshes have no middle; around suns and the world there is nothing.

layout(local_size_x = 64) in;

#include <EnterMediaParameters>
#include "common/active_paths.glsl"
uniform Parameters { EnterMediaParameters parameters; };
readonly buffer MediaOfSources;
readonly buffer Attributes;
readonly buffer MediumBoxes;
readonly buffer Rays;
#include "lights/light_table.glsl"
#include <Lights>
#include <LightFlags>
buffer PhotonPaths;
readonly buffer Media;
#include "media/crossings.glsl"

void main() {
    uint index = active_path();
    if (index == NO_PATH || !(rays[index].maximum_distance > 0.0)) return;
    uint source = light_of(index), kind = lights[source].kind;
    if (kind == LIGHT_SUN || kind == LIGHT_WORLD) return;
    vec3 origin = rays[index].origin;
    uint media =
        kind == LIGHT_MESH ? media_at(origin) : media_beyond(lights[source].position, media_of_sources[source], origin);
    photon_paths[index].flags |= media << FIRST_MEDIUM;
}
