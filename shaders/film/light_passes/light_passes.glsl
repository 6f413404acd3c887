// SPDX-License-Identifier: GPL-3.0-or-later
// What light adds to the passes that separate what makes it (scene/passes.py).
#include "common/bsdf/microfacet.glsl"
#include "common/gathering.glsl"
#include "common/path_history.glsl"
#include "film/passes.glsl"

// indirect: other surfaces have sent it to the first.
void add_scattered_light(uint scatter, bool indirect, uint pixel, vec3 light) {
    add_to_pass(PASS_DIFFUSE_DIRECT + 3u * (scatter - SCATTER_DIFFUSE) + (indirect ? 1u : 0u), pixel, light);
}

// Of a medium that nothing but transparent surfaces hides from the camera. indirect: surfaces or media have sent it
// there.
void add_volume_light(bool indirect, uint pixel, vec3 light) {
    add_to_pass(indirect ? PASS_VOLUME_INDIRECT : PASS_VOLUME_DIRECT, pixel, light);
}
