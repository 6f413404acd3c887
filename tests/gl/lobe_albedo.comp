#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Albedo of one lobe twice: by sampling it, and by evaluating it over uniform directions.

layout(local_size_x = 64) in;

#include <LobeTestParameters>
#include "common/invocation.glsl"
#include "common/random.glsl"
#include "common/bsdf/microfacet.glsl"
layout(std140, binding = 0) uniform Parameters { LobeTestParameters parameters; };
layout(std430, binding = 0) writeonly buffer Results { vec4 results[]; };

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    RandomSequence random = random_sequence(7u, 1u, 1u, 0u, index);
    MicrofacetLobe lobe = MicrofacetLobe(parameters.weight, parameters.kind, parameters.f0, parameters.alpha, vec3(1.0), parameters.ior, 0u, ISOTROPIC);
    vec3 n = normalize(vec3(0.3, -0.5, 0.8)), t, b;
    tangent_frame(n, t, b);
    vec3 wo = normalize(sqrt(1.0 - parameters.cosine * parameters.cosine) * t + parameters.cosine * n);
    LobeSample sampled = sample_lobe(lobe, n, wo, next_random2(random), next_random(random), parameters.radiance != 0u);
    vec3 wi = sample_sphere(next_random2(random));
    vec3 evaluated = evaluate_lobe(lobe, n, wo, wi) * abs(dot(wi, n)) * 4.0 * PI;
    results[3u * index] = vec4(sampled.weight, sampled.transmitted ? 1.0 : 0.0);
    results[3u * index + 1u] = vec4(evaluated, dot(wi, n) < 0.0 ? 1.0 : 0.0);
    // reciprocity of reflection, and Walter's of transmission with the squared indices
    bool through = dot(wi, n) < 0.0;
    MicrofacetLobe back = lobe;
    if (through) back.ior = 1.0 / lobe.ior;
    vec3 forward = evaluate_lobe(lobe, n, wo, wi), reverse = evaluate_lobe(back, through ? -n : n, wi, wo);
    results[3u * index + 2u] = vec4(forward.x, reverse.x, through ? 1.0 : 0.0, 0.0);
}
