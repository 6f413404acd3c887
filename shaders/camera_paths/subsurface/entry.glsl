// SPDX-License-Identifier: GPL-3.0-or-later
// How a random walk begins. The includer declares before parameters with seed, iteration and segment.

#include <SubsurfaceWalk>
#include "common/random.glsl"
#include "common/bsdf/subsurface.glsl"
writeonly buffer SubsurfaceWalks;
writeonly buffer WalkRays;

// The albedos of single scattering by which a half space reflects so much, and the extinctions, 1/m. g: anisotropy.
// D'Eon, A Hitchhiker's Guide to Multiple Scattering (v0.3.2), eq. 53.7, with van de Hulst's similarity.
void similar_medium(vec3 reflected, vec3 radius, float g, out vec3 albedo, out vec3 extinction) {
    vec3 s = 4.20863 * reflected - sqrt(9.59217 + reflected * (41.6808 + 17.7126 * reflected)) + 4.09712;
    albedo = (1.0 - s * s) / (1.0 - g * s * s);
    extinction = 1.0 / max(radius, 1e-16);
}

float polynomial(float x, vec4 low, vec4 high) {
    float x2 = x * x;
    vec4 powers = vec4(1.0, x, x2, x2 * x);
    return dot(low, powers) + x2 * x2 * dot(high, powers);
}

// The same by the fit of Chiang, Kutz and Burley (Practical and Controllable Subsurface Scattering for Production Path
// Tracing, 2016) as Wrenninge, Villemin and Hery extended it to anisotropies from 0 on (Path Traced Subsurface
// Scattering using Anisotropic Phase Functions and Non-Exponential Free Flights, 2017). The radius is that of reduced
// extinction.
void fitted_medium(vec3 reflected, vec3 radius, float g, out vec3 albedo, out vec3 extinction) {
    float a = polynomial(g, vec4(1.8260523782, -1.28451056436, -1.79904629312, 9.19393289202),
                         vec4(-22.8215585862, 32.0234874259, -23.6264803333, 7.21067002658)),
          b = 4.98511194385
              + 0.127355959438
                    * exp(polynomial(g, vec4(0.0, 31.1491581433, -201.847017512, 841.576016723),
                                     vec4(-2018.09288505, 2731.71560286, -1935.41424244, 559.009054474))),
          c = polynomial(g, vec4(1.09686102424, -0.394704063468, 1.05258115941, -8.83963712726),
                         vec4(28.8643230661, -46.8802913581, 38.5402837518, -12.7181042538)),
          d = polynomial(g, vec4(0.496310210422, 0.360146581622, -2.15139309747, 17.8896899217),
                         vec4(-55.2984010333, 82.065982243, -58.5106008578, 15.8478295021)),
          e = 4.23190299701
              + 0.00310603949088
                    * exp(polynomial(g, vec4(0.0, 76.7316253952, -594.356773233, 2448.8834203),
                                     vec4(-5576.68528998, 7116.60171912, -4763.54467887, 1303.5318055))),
          f = polynomial(g, vec4(2.40602999408, -2.51814844609, 9.18494908356, -79.2191708682),
                         vec4(259.082868209, -403.613804597, 302.85712436, -87.4370473567));
    vec3 blend = sqrt(sqrt(reflected));
    albedo = (1.0 - blend) * a * pow(atan(b * reflected), vec3(c)) + blend * d * pow(atan(e * reflected), vec3(f));
    extinction = 1.0 / (max(radius, 1e-16) * (1.0 - g));
}

// direction: below the surface; a null vector where the path does not get in. throughput: of light that comes out, the
// albedo in it; the largest is about 1.
void begin_walk(uint index, Closure closure, Subsurface part, vec3 direction, vec3 throughput) {
    vec3 albedo, extinction;
    if (part.method == SUBSURFACE_RANDOM_WALK || part.anisotropy < 0.0)
        similar_medium(part.albedo, part.radius, part.anisotropy, albedo, extinction);
    else fitted_medium(part.albedo, part.radius, part.anisotropy, albedo, extinction);
    albedo = clamp(albedo, 0.0, 0.999999);
    // Light that hardly scatters once would take all steps to the surface: it scatters more, with less weight.
    const float least = 0.2;
    throughput *= mix(vec3(0.0), min(albedo / least, 1.0) / part.albedo, greaterThan(part.albedo, vec3(0.0)));
    bool walks = direction != vec3(0.0) && largest(throughput) > 0.0;
    subsurface_walks[index] = SubsurfaceWalk(throughput, 0u, closure.position, -1.0, extinction, part.anisotropy,
                                             max(albedo, least), closure.shading_normal);
    vec3 origin = closure.position - closure.ray_offset * unpack_unit_vector(closure.geometric_normal);
    walk_rays[index] = Ray(origin, closure.triangle, direction, walks ? 1.0 : 0.0);
}
