#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// One lobe twice: sampled, and evaluated over uniform directions.

layout(local_size_x = 64) in;

#include <LobeTestParameters>
#include "common/invocation.glsl"
#include "common/random.glsl"
#include "common/bsdf/microfacet.glsl"
uniform Parameters { LobeTestParameters parameters; };
writeonly buffer Results { vec4 results[]; };

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    RandomSequence random = random_sequence(7u, 1u, 1u, 0u, index);
    vec3 n = unpack_unit_vector(pack_unit_vector(normalize(vec3(0.3, -0.5, 0.8)))), t, b;
    tangent_frame(n, t, b);
    uint anisotropy =
        pack_anisotropy(n, normalize(t + 0.4 * b), parameters.aspect) | (parameters.beckmann != 0u ? BECKMANN : 0u);
    MicrofacetLobe lobe = MicrofacetLobe(parameters.weight, parameters.kind, parameters.f0, parameters.alpha,
                                         parameters.tint, parameters.ior, pack_unit_vector(n), anisotropy);
    vec3 wo = normalize(sqrt(1.0 - parameters.cosine * parameters.cosine) * t + parameters.cosine * n);
    LobeSample sampled =
        sample_lobe(lobe, n, wo, sample_disk(next_random2(random)), next_random(random), parameters.radiance != 0u);
    vec3 wi = sample_sphere(next_random2(random));
    vec3 evaluated = evaluate_lobe(lobe, n, wo, wi) * abs(dot(wi, n)) * 4.0 * PI;
    results[5u * index] = vec4(sampled.weight, sampled.transmitted ? 1.0 : 0.0);
    results[5u * index + 1u] = vec4(evaluated, dot(wi, n) < 0.0 ? 1.0 : 0.0);
    // reciprocity of reflection, and Walter's of transmission with the squared indices
    bool through = dot(wi, n) < 0.0;
    MicrofacetLobe back = lobe;
    if (through) back.ior = 1.0 / lobe.ior;
    vec3 forward = evaluate_lobe(lobe, n, wo, wi), reverse = evaluate_lobe(back, through ? -n : n, wi, wo);
    results[5u * index + 2u] = vec4(forward.x, reverse.x, through ? 1.0 : 0.0, abs(dot(wi, n)) * 4.0 * PI);
    // The direction's pdf, by the means of functions of it.
    vec3 at = sampled.direction;
    results[5u * index + 3u] = largest(sampled.weight) > 0.0 ? vec4(1.0, at.x, at.y * at.y, at.z * at.x) : vec4(0.0);
    float pdf = largest(evaluated) > 0.0 ? lobe_pdf(lobe, n, wo, wi) * 4.0 * PI : 0.0;
    results[5u * index + 4u] = pdf * vec4(1.0, wi.x, wi.y * wi.y, wi.z * wi.x);
}
