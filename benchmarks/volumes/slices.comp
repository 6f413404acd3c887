// SPDX-License-Identifier: GPL-3.0-or-later
// Transmittance along the rays through the pixels' centers, for splats in the cloud. Once a picture.
layout(local_size_x = 8, local_size_y = 8) in;
layout(r32f, binding = 2) uniform writeonly image3D transmittances;
const int STEPS = 6;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= WIDTH || pixel.y >= HEIGHT) return;
    vec3 along = camera_ray(vec2(pixel) + 0.5);
    float depth = 0.0, span = 2.0 / float((SLICES - 1) * STEPS);
    for (int i = 0; i < SLICES; ++i) {
        imageStore(transmittances, ivec3(pixel, i), vec4(exp(-depth)));
        for (int k = 0; k < STEPS; ++k) {
            float t = 2.6 + span * (float(i * STEPS + k) + 0.5);
            depth += span * extinction(EYE + t * along);
        }
    }
}
