#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// A lobe of a fiber: sampled, and evaluated over uniform directions. The fiber lies along x, the normal is that of the
// place whose distance from the middle is h as the viewer sees it.
// lint: HAIR_LOBES=1

layout(local_size_x = 64) in;

#include <HairTestParameters>
#include "common/invocation.glsl"
#include "common/random.glsl"
#include "common/bsdf/microfacet.glsl"
uniform Parameters { HairTestParameters parameters; };
writeonly buffer Results { vec4 results[]; };

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    RandomSequence random = random_sequence(7u, 1u, 1u, 0u, index);
    float sine = parameters.sine, cosine = sqrt(1.0 - sine * sine), h = parameters.h;
    vec3 tangent = vec3(1.0, 0.0, 0.0), wo = vec3(sine, 0.0, cosine), side = vec3(0.0, -1.0, 0.0);
    vec3 n = unpack_unit_vector(pack_unit_vector(normalize(-h * side + sqrt(1.0 - h * h) * vec3(0.0, 0.0, 1.0))));
    uint anisotropy = pack_unit_vector(tangent);
    if (parameters.kind >= LOBE_HAIR_CHIANG) {
        vec3 t, b;
        tangent_frame(n, t, b);
        float turn = fract(atan(dot(tangent, b), dot(tangent, t)) / (2.0 * PI));
        anisotropy = packUnorm2x16(vec2(turn, parameters.offset / PI + 0.5)) | HAIR_ON_STRAND;
    }
    MicrofacetLobe lobe = MicrofacetLobe(vec3(1.0), parameters.kind, parameters.f0, 0.06, parameters.tint,
                                         parameters.ior, pack_unit_vector(n), anisotropy);
    LobeSample sampled = sample_lobe(lobe, n, wo, sample_disk(next_random2(random)), next_random(random), true);
    vec3 wi = sample_sphere(next_random2(random));
    LobeValue value = lobe_value(lobe, n, wo, wi);
    float sphere = 4.0 * PI;
    vec3 at = sampled.direction;
    LobeValue there = lobe_value(lobe, n, wo, at);
    results[4u * index] = vec4(sampled.weight, there.pdf);
    results[4u * index + 1u] = vec4(value.bsdf * abs(dot(wi, n)), value.pdf) * sphere;
    if (parameters.kind == LOBE_HAIR_HUANG) {  // which has no pdf
        vec3 scattered = value.bsdf * abs(dot(wi, n));
        results[4u * index + 2u] = sampled.weight.y * vec4(1.0, at.x, at.y * at.y, at.z * at.x);
        results[4u * index + 3u] = scattered.y * sphere * vec4(1.0, wi.x, wi.y * wi.y, wi.z * wi.x);
        return;
    }
    results[4u * index + 2u] = vec4(there.pdf > 0.0 ? 1.0 : 0.0, at.x, at.y * at.y, at.z * at.x);
    // As in Cycles, transmission has a pdf also where nothing is sampled, in front of the fiber.
    if (parameters.kind == LOBE_HAIR_TRANSMISSION && wi.z > 0.0) value.pdf = 0.0;
    results[4u * index + 3u] = value.pdf * sphere * vec4(1.0, wi.x, wi.y * wi.y, wi.z * wi.x);
}
