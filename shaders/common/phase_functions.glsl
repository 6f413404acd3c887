// SPDX-License-Identifier: GPL-3.0-or-later
// Phase functions, 1/sr, by the cosine between the directions in which light travels before and after it is scattered:
// 1 is straight on. Each is normalized over the sphere and sampled exactly, by the inverse of its distribution of
// cosines. With MEDIA the includer includes materials/medium.glsl before.

#include <PhaseFunction>
#include <PhaseFunctionKinds>
#include "common/constants.glsl"

const float ISOTROPIC_PHASE = 0.25 / PI;
// Anisotropy below which light is scattered evenly, as in Cycles.
const float LEAST_ANISOTROPY = 1e-3;

float henyey_greenstein_phase(float g, float cosine) {
    if (abs(g) < LEAST_ANISOTROPY) return ISOTROPIC_PHASE;
    // 1 + g^2 - 2 g cosine, as a sum of what is positive: near the peak a difference would lose it.
    float rest = 1.0 - abs(g), root = rest * rest + 2.0 * abs(g) * (1.0 - (g > 0.0 ? cosine : -cosine));
    return ISOTROPIC_PHASE * (1.0 - g * g) / (root * sqrt(root));
}

// The cosine below which the fraction u of the light is.
float henyey_greenstein_cosine(float g, float u) {
    float t = 2.0 * u - 1.0, g2 = g * g;
    if (abs(g) < LEAST_ANISOTROPY) return t;
    float k = 1.0 / (1.0 + g * t), straight = (1.0 - g2) * k;
    // The same twice: the one cancels where g is small, the other where it is large.
    float cosine = abs(g) > 0.5 ? (1.0 + g2 - straight * straight) / (2.0 * g)
                                : (t * (1.0 + g2) + 0.5 * g * (3.0 - g2 + t * t * (1.0 + g2))) * k * k;
    return clamp(cosine, -1.0, 1.0);
}

float rayleigh_phase(float cosine) { return 0.75 * ISOTROPIC_PHASE * (1.0 + cosine * cosine); }

float rayleigh_cosine(float u) {
    float a = abs(4.0 * u - 2.0), root = pow(a + sqrt(1.0 + a * a), 1.0 / 3.0);
    return clamp(sign(u - 0.5) * (root - 1.0 / root), -1.0, 1.0);
}

// The integral of Draine's function over all directions, as long as it is not normalized.
float draine_norm(float g, float alpha) { return 1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0; }

float draine_phase(float g, float alpha, float cosine) {
    return henyey_greenstein_phase(g, cosine) * (1.0 + alpha * cosine * cosine) / draine_norm(g, alpha);
}

// Integral of the squared cosine over the fraction u of the light that Henyey and Greenstein's function scatters least
// far ahead. Where g is small its closed form cancels, and four points of Gauss are as good.
float squared_cosine_integral(float g, float u) {
    if (abs(g) < 0.15) {
        const vec2 NODES = vec2(0.33998104, 0.86113631), WEIGHTS = vec2(0.65214515, 0.34785485);
        float sum = 0.0;
        for (int k = 0; k < 4; ++k) {
            float offset = (k & 1) == 0 ? NODES[k >> 1] : -NODES[k >> 1];
            float cosine = henyey_greenstein_cosine(g, 0.5 * u * (1.0 + offset));
            sum += WEIGHTS[k >> 1] * cosine * cosine;
        }
        return 0.5 * u * sum;
    }
    // With s the distance of points on two circles, of radius 1 and g: cosine = (a - s^2) / 2g.
    float a = 1.0 + g * g, s0 = 1.0 + g, s1 = (1.0 - g * g) / (1.0 - g + 2.0 * g * u);
    float integral = a * a * (1.0 / s1 - 1.0 / s0) - 2.0 * a * (s0 - s1) + (s0 * s0 * s0 - s1 * s1 * s1) / 3.0;
    return (1.0 - g * g) / (8.0 * g * g * g) * integral;
}

// By Newton's method on the fraction of light by Henyey and Greenstein's function, where the slope is within a factor
// of 1 + alpha, with bisection where it leaves the bracket.
float draine_cosine(float g, float alpha, float u) {
    float norm = draine_norm(g, alpha), low = 0.0, high = 1.0, v = u;
    for (int k = 0; k < 24; ++k) {
        float excess = v + alpha * squared_cosine_integral(g, v) - u * norm;
        if (excess > 0.0) high = v;
        else low = v;
        float cosine = henyey_greenstein_cosine(g, v);
        float next = v - excess / (1.0 + alpha * cosine * cosine);
        if (!(next > low && next < high)) next = 0.5 * (low + high);
        if (abs(next - v) < 1e-7) break;
        v = next;
    }
    return henyey_greenstein_cosine(g, v);
}

// 1 - x^p for x > 0, exact also near x = 1.
float one_minus_power(float x, float p) {
    float y = p * log(x);
    return abs(y) < 0.05 ? -y * (1.0 + y * (0.5 + y * (1.0 / 6.0 + y / 24.0))) : 1.0 - exp(y);
}

// The variable delta of Fournier and Forand, by the squared sine of half the angle.
float fournier_forand_delta(float n, float half_sine2) { return 4.0 * half_sine2 / (3.0 * (n - 1.0) * (n - 1.0)); }

// Least squared sine of half an angle: floats tell cosines no better from 1, where the function has no limit.
const float LEAST_HALF_SINE2 = 3e-8;

// fit: n, nu and the factor of PHASE_FOURNIER_FORAND.
float fournier_forand_phase(vec3 fit, float cosine) {
    float n = fit.x, nu = fit.y, s2 = max(0.5 * (1.0 - cosine), LEAST_HALF_SINE2);
    float delta = fournier_forand_delta(n, s2), e = 1.0 - delta, power = pow(delta, nu), peak;
    if (abs(e) < 0.02) {
        // The same to first order in e, as both parts of the sum vanish with e^2.
        float once = 0.5 * nu * (nu - 1.0) * (1.0 - (nu - 2.0) / 3.0 * e);
        float by_sine = 0.5 * nu * (nu + 1.0) * ((nu - 1.0) / 3.0 * e - 1.0);
        peak = once + by_sine / s2;
    } else {
        float missing = one_minus_power(delta, nu);
        peak = (nu * e - missing + (delta * missing - nu * e) / s2) / (e * e);
    }
    return max(ISOTROPIC_PHASE * (peak / power + 0.25 * fit.z * (3.0 * cosine * cosine - 1.0)), 0.0);
}

// Fraction of the light that is scattered by less than the angle.
float fournier_forand_fraction(vec3 fit, float half_sine2) {
    float n = fit.x, nu = fit.y, x = half_sine2, delta = fournier_forand_delta(n, x), e = 1.0 - delta;
    float ratio = abs(e) < 1e-4 ? (nu + 1.0) * (1.0 - 0.5 * nu * e) - nu * (1.0 - 0.5 * (nu - 1.0) * e) * x
                                : (one_minus_power(delta, nu + 1.0) - one_minus_power(delta, nu) * x) / e;
    float cosine = 1.0 - 2.0 * x;
    return ratio * pow(delta, -nu) + 0.5 * fit.z * cosine * x * (1.0 - x);
}

// By Newton's method on the power of the squared sine by which the fraction begins, with bisection as above.
float fournier_forand_cosine(vec3 fit, float u) {
    float power = max(-fit.y, 1e-3), low = 0.0, high = 1.0, y = 1.0 - u, aim = y, x = 0.0;
    for (int k = 0; k < 32; ++k) {
        x = pow(y, 1.0 / power);
        float excess = fournier_forand_fraction(fit, max(x, 1e-30)) - aim;
        if (excess > 0.0) high = y;
        else low = y;
        float slope = 4.0 * PI * fournier_forand_phase(fit, 1.0 - 2.0 * x) * x / (power * max(y, 1e-30));
        float next = y - excess / max(slope, 1e-30);
        if (!(next > low && next < high)) next = 0.5 * (low + high);
        if (abs(next - y) < 1e-7) break;
        y = next;
    }
    return clamp(1.0 - 2.0 * x, -1.0, 1.0);
}

// 1/sr.
float evaluate_phase_function(PhaseFunction f, float cosine) {
    switch (f.kind) {
    case PHASE_FOURNIER_FORAND: return fournier_forand_phase(f.parameters.xyz, cosine);
    case PHASE_DRAINE: return draine_phase(f.parameters.x, f.parameters.y, cosine);
    case PHASE_RAYLEIGH: return rayleigh_phase(cosine);
    default: return henyey_greenstein_phase(f.parameters.x, cosine);
    }
}

// The cosine of a scattered direction by a random number in [0, 1).
float sample_phase_function(PhaseFunction f, float u) {
    switch (f.kind) {
    case PHASE_FOURNIER_FORAND: return fournier_forand_cosine(f.parameters.xyz, u);
    case PHASE_DRAINE: return draine_cosine(f.parameters.x, f.parameters.y, u);
    case PHASE_RAYLEIGH: return rayleigh_cosine(u);
    default: return henyey_greenstein_cosine(f.parameters.x, u);
    }
}

#ifdef MEDIA
layout(rgba32ui) restrict readonly uniform uimageBuffer PhaseFunctions;

// Read as texels: programs that sample lights have no storage block left.
PhaseFunction phase_function(uint k) {
    uvec4 first = imageLoad(PhaseFunctions, 2 * int(k));
    vec4 parameters = uintBitsToFloat(imageLoad(PhaseFunctions, 2 * int(k) + 1));
    return PhaseFunction(uintBitsToFloat(first.xyz), first.w, parameters);
}

#ifdef HETEROGENEOUS_MEDIA
// What the scattering coefficients of a medium's phase functions are multiplied by at a place.
vec3 scattering_factor(uint medium, PlaceOnRay at) {
    if (!has_grid(medium)) return vec3(1.0);
    vec3 sum = vec3(0.0);
    uint first = media[medium].first_function, end = first + media[medium].function_count;
    for (uint k = first; k < end; ++k) sum += phase_function(k).scattering;
    return grid_coefficients(medium, at).scattering / max(sum, vec3(1e-30));
}
#endif

// Scattering coefficient of a medium by its number times its phase function, 1/(m sr).
vec3 medium_scattered_phase(uint medium, PlaceOnRay at, float cosine) {
    vec3 sum = vec3(0.0);
    uint first = media[medium].first_function, end = first + media[medium].function_count;
    for (uint k = first; k < end; ++k)
        sum += phase_function(k).scattering * evaluate_phase_function(phase_function(k), cosine);
#ifdef HETEROGENEOUS_MEDIA
    if (end > first) sum *= scattering_factor(medium, at);
#endif
    return sum;
}

// The same of all media that a path is in.
vec3 scattered_phase(uint flags, PlaceOnRay at, float cosine) {
    vec3 sum = medium_scattered_phase(0u, at, cosine);
    uint bits = medium_bits();
    for (uint set = flags >> FIRST_MEDIUM; set != 0u;)
        sum += medium_scattered_phase(next_medium(set, bits), at, cosine);
    return sum;
}

// The mean phase function of all channels, 1/sr; scattering: coefficient of the media, 1/m.
float mean_phase(uint flags, PlaceOnRay at, float cosine, vec3 scattering) {
    return dot(scattered_phase(flags, at, cosine), vec3(1.0)) / max(dot(scattering, vec3(1.0)), 1e-30);
}

// A phase function of the media that a path is in, chosen by what it scatters of each color's weight, and the random
// number, which is as good as new.
PhaseFunction sample_path_phase_function(uint flags, PlaceOnRay at, vec3 weight, inout float u) {
    float rest = u * dot(weight, path_medium(flags, at).scattering);
    PhaseFunction chosen = PhaseFunction(vec3(0.0), PHASE_HENYEY_GREENSTEIN, vec4(0.0));
    uint bits = medium_bits(), set = flags >> FIRST_MEDIUM, medium = 0u;
    for (;;) {
        uint first = media[medium].first_function, end = first + media[medium].function_count;
        for (uint k = first; k < end; ++k) {
            PhaseFunction found = phase_function(k);
#ifdef HETEROGENEOUS_MEDIA
            found.scattering *= scattering_factor(medium, at);
#endif
            float part = dot(weight, found.scattering);
            if (part <= 0.0) continue;
            chosen = found;
            if (rest < part) {
                u = rest / part;
                return chosen;
            }
            rest -= part;
            u = 0.999999;  // should rounding leave none
        }
        if (set == 0u) return chosen;
        medium = next_medium(set, bits);
    }
}
#endif
