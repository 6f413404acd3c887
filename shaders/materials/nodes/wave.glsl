// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/constants.glsl"
#include "materials/nodes/fractal_noise.glsl"
#include <WaveOptions>

void node_tex_wave(int wave_type, int bands_direction, int rings_direction, int wave_profile, vec3 vector, float scale,
                   float distortion, float detail, float detail_scale, float detail_roughness, float phase_offset,
                   out vec3 color, out float fac) {
    // Cycles' nudge keeps whole coordinates off the borders.
    vec3 p = (vector * scale + 0.000001) * 0.999999;
    float phase;
    if (wave_type == WAVE_BANDS) {
        phase = bands_direction == BANDS_DIAGONAL ? (p.x + p.y + p.z) * 10.0 : p[bands_direction] * 20.0;
    } else {
        vec3 axes = vec3(rings_direction != RINGS_X, rings_direction != RINGS_Y, rings_direction != RINGS_Z);
        phase = length(p * axes) * 20.0;
    }
    phase += phase_offset;
    // No turns without distortion: a loop is skipped where a branch may not be.
    int turns = distortion != 0.0 ? 1 : 0;
    for (int turn = 0; turn < turns; ++turn) {
        float noise = fractal_noise(3, NOISE_FBM, 1, vec4(p * detail_scale, 0.0), clamp(detail, 0.0, 15.0),
                                    detail_roughness, 2.0, 0.0, 1.0);
        phase += distortion * (noise * 2.0 - 1.0);
    }
    if (wave_profile == PROFILE_SIN) {
        fac = 0.5 + 0.5 * sin(phase - 0.5 * PI);
    } else {
        float cycles = phase / (2.0 * PI);
        fac = wave_profile == PROFILE_SAW ? cycles - floor(cycles) : 2.0 * abs(cycles - floor(cycles + 0.5));
    }
    color = vec3(fac);
}
