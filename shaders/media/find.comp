#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint: TRAVERSAL=deep_cubemap/traverse.glsl MEDIA=1
// lint: TRAVERSAL=deep_cubemap/traverse.glsl TEXEL_BUFFERS=1 MEDIA=1
// lint: TRAVERSAL=bvh/traverse.glsl MEDIA=1
// lint: TRAVERSAL=bvh/traverse_two_levels.glsl MEDIA=1 HITS=media/two_levels
// lint: TRAVERSAL=deep_cubemap/traverse_two_levels.glsl TEXEL_BUFFERS=1 MEDIA=1 HITS=media/two_levels
// The media at the middle of each light object, and behind them at the camera.

layout(local_size_x = 64) in;

#include <FindMediaParameters>
#include "common/iteration.glsl"
#include "common/invocation.glsl"
uniform Parameters { FindMediaParameters parameters; };
writeonly buffer MediaOfSources;
readonly buffer Attributes;
#include "lights/light_table.glsl"
readonly buffer Media;
#include "media/crossings.glsl"

void main() {
    uint index = invocation_index();
    if (index > iteration.light_count) return;
    bool camera = index == iteration.light_count;
    vec3 point = parameters.camera_position;
    if (!camera) point = lights[index].position;
    media_of_sources[index] = is_at_surface(point) ? MEDIA_UNKNOWN : media_at(point);
}
