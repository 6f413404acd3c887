// SPDX-License-Identifier: GPL-3.0-or-later
// Hair as Huang, Hullin and Hanika have it (A Microfacet-based Hair Scattering Model, 2022), with the terms of Cycles:
// a fiber with tilted scales of rough microfacets, whose section is an ellipse that lies across the view. What it
// scatters is a mean over its width, or over what a pixel of the camera sees of it.
//
// weight: of R, TT, TRT; f0: absorption over the fiber's radius; ior; tint: minor over major axis, roughness, and half
// of a pixel over the radius; anisotropy: as common/bsdf/hair_chiang.glsl has it.
//
// In the frame of a fiber y lies along it, x across it and the view, and z to the viewer. gamma is the angle around the
// fiber of a point of the ellipse, (sin gamma, aspect cos gamma).

#include <HairEnergy>

struct Huang {
    HairFrame frame;
    float aspect;
    float roughness;
    float tilt;
    float h;
    float coverage;    // half the width that a mean is over; 1: all
    vec3 entering[2];  // of huang_scale
    vec3 leaving[2];
};

// What single scattering by microfacets of glass loses, over the squared roughness: a polynomial in 1 - cosine, fit to
// the table of albedos.
void glass_loss(int table, float roughness, float ior, out vec3 terms[2]) {
    float root = sqrt(roughness), place = sqrt(abs(ior - 1.0) / (ior + 1.0));
    for (int j = 0; j < 6; ++j) {
        float sum = 0.0;
        for (int i = 4; i >= 0; --i) {
            int at = table + 2 * (6 * i + j);
            sum = sum * root + HAIR_ENERGY[at] + HAIR_ENERGY[at + 1] * place;
        }
        terms[j / 3][j % 3] = roughness * sum;
    }
}

// What gives back to microfacets seen by this cosine the energy that they lose.
float huang_scale(vec3 terms[2], float cosine) {
    float x = 1.0 - clamp(cosine, 0.0, 1.0), x3 = x * x * x;
    vec3 powers = vec3(1.0, x, x * x);
    return 1.0 / clamp(1.0 - dot(terms[0] + terms[1] * x3, powers), 0.25, 1.0);
}

Huang huang(MicrofacetLobe lobe, vec3 n, vec3 wo) {
    Huang hair;
    hair.frame = hair_frame(chiang_tangent(lobe), wo);
    hair.aspect = clamp(lobe.tint.x, 0.05, 1.0);
    hair.roughness = clamp(lobe.tint.y, 0.001, 1.0);
    hair.tilt = -hair_offset(lobe);
    hair.h = clamp(-dot(n, hair.frame.side), -0.999, 0.999);
    hair.coverage = max(lobe.tint.z, 0.002);
    glass_loss(0, hair.roughness, lobe.ior, hair.entering);
    glass_loss(60, hair.roughness, lobe.ior, hair.leaving);
    return hair;
}

vec3 in_fiber(HairFrame frame, vec3 w) { return vec3(dot(w, frame.side), dot(w, frame.tangent), dot(w, frame.across)); }

float fiber_cosine(vec3 w) { return max(length(w.xz), 1e-4); }

float ellipse_azimuth(float gamma, float aspect) { return atan(aspect * sin(gamma), cos(gamma)); }

// The normal of scales, turned along the fiber by tilt.
vec3 scale_normal(float tilt, float gamma, float aspect) {
    vec2 around = normalize(vec2(aspect * sin(gamma), cos(gamma)));
    return vec3(around.x * cos(tilt), sin(tilt), around.y * cos(tilt));
}

float chord(float gamma_a, float gamma_b, float aspect) {
    return length(vec2(sin(gamma_a) - sin(gamma_b), aspect * (cos(gamma_a) - cos(gamma_b))));
}

float arc_length(float aspect, float gamma) {
    float s = sin(gamma);
    return sqrt(max(1.0 - (1.0 - aspect * aspect) * s * s, 0.0));
}

float facet_density(float roughness, float cosine) {
    float alpha2 = roughness * roughness, d = (alpha2 - 1.0) * cosine * cosine + 1.0;
    return alpha2 / (PI * d * d);
}

float facet_shadow(float roughness, float cosine) {
    float c2 = max(cosine * cosine, 1e-8);
    return 0.5 * (sqrt(1.0 + roughness * roughness * (1.0 - min(c2, 1.0)) / c2) - 1.0);
}

float both_masking(float roughness, float cosine_i, float cosine_o) {
    return 1.0 / (1.0 + facet_shadow(roughness, cosine_i) + facet_shadow(roughness, cosine_o));
}

// Over the masking of the first alone.
float other_masking(float roughness, float cosine_i, float cosine_o) {
    float first = facet_shadow(roughness, cosine_i);
    return (1.0 + first) / (1.0 + first + facet_shadow(roughness, cosine_o));
}

bool facet_visible(vec3 v, vec3 m, vec3 h) { return dot(v, h) > 0.0 && dot(v, m) > 0.0; }

// What is summed by chance is drawn anew where whoever evaluates sets this, and for each pair of directions.
uint fiber_seed = 0u;

// O'Neill's PCG.
float fiber_random(inout uint state) {
    state = state * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return float(((word >> 22u) ^ word) >> 8u) * (1.0 / 16777216.0);
}

uint fiber_state(vec3 a, vec3 b) {
    uvec3 x = floatBitsToUint(a), y = floatBitsToUint(b);
    x *= uvec3(73856093u, 19349663u, 83492791u);
    y *= uvec3(2654435761u, 40503u, 2246822519u);
    return fiber_seed ^ x.x ^ x.y ^ x.z ^ y.x ^ y.y ^ y.z;
}

vec3 sample_scale_facet(float roughness, vec3 w, vec3 m, inout uint state) {
    vec3 s, t;
    tangent_frame(m, s, t);
    vec2 u = vec2(fiber_random(state), 0.0);
    u.y = fiber_random(state);
    vec3 h = sample_visible_normal(vec3(dot(w, s), dot(w, t), dot(w, m)), vec2(roughness), sample_disk(u));
    return h.x * s + h.y * t + h.z * m;
}

// What of the fiber's width a mean is over: all, or what a pixel sees.
vec2 seen_width(Huang hair) {
    return hair.coverage < 1.0 ? clamp(vec2(hair.h - hair.coverage, hair.h + hair.coverage), -1.0, 1.0)
                               : vec2(-1.0, 1.0);
}

// Cycles' integrals by Simpson's rule, of which the error is part of its picture; of smoother fibers fewer steps, from
// a random start.
const int MOST_FIBER_STEPS = 48;

struct FiberSteps {
    int count;
    float start;
    float size;
    bool simpson;
};

FiberSteps fiber_steps(vec2 range, float most, inout uint state) {
    float extent = range.y - range.x;
    int wanted = 2 * int(clamp(ceil(0.5 * extent / most), 1.0, 1e4));
    FiberSteps steps = FiberSteps(min(wanted, MOST_FIBER_STEPS), range.x, 0.0, wanted <= MOST_FIBER_STEPS);
    steps.size = extent / float(steps.count);
    if (!steps.simpson) steps.start += fiber_random(state) * steps.size;
    return steps;
}

int last_step(FiberSteps steps) { return steps.simpson ? steps.count : steps.count - 1; }

// The angle around the fiber, and what that much of it weighs.
float fiber_step(FiberSteps steps, int i, out float weight) {
    bool end = i == 0 || i == steps.count;
    float h = steps.start + float(i) * steps.size;
    weight = steps.simpson ? steps.size * (end ? 1.0 : (i & 1) == 1 ? 4.0 : 2.0) / 3.0 : steps.size;
    weight *= inversesqrt(1.0 - h * h);
    return -asin(h);
}

float reflected_by_scales(MicrofacetLobe lobe, Huang hair, vec3 v, vec3 l, vec2 range, inout uint state) {
    vec3 h = normalize(v + l);
    FiberSteps steps = fiber_steps(range, 0.7 * hair.roughness, state);
    float sum = 0.0;
    for (int i = 0; i <= last_step(steps); ++i) {
        float weight, gamma = fiber_step(steps, i, weight);
        vec3 m = scale_normal(hair.tilt, gamma, hair.aspect), plain = vec3(m.x, 0.0, m.z);
        if (!facet_visible(v, plain, h) || !facet_visible(l, plain, h)) continue;
        float cosine = dot(m, v);
        sum += weight * facet_density(hair.roughness, dot(m, h)) * both_masking(hair.roughness, cosine, dot(m, l))
               * arc_length(hair.aspect, gamma) * huang_scale(hair.entering, cosine);
    }
    return 0.25 * fresnel_dielectric(dot(v, h), lobe.ior) * sum;
}

// Of light that is reflected twice within and more often.
vec3 residual_of(float transmitted, float reflected, vec3 absorbed) {
    float mean = max(1.0 - reflected, 1e-5);
    vec3 thrice = absorbed * absorbed * absorbed;
    return transmitted * reflected * reflected * mean * thrice / (1.0 - absorbed * (1.0 - mean));
}

// A path within a fiber on its way to a facet.
struct Within {
    vec3 direction;  // of travel
    float gamma;     // of the inner normal that it comes to
    vec3 normal;     // tilted
    vec3 plain;      // and not
    float cosine;    // of where it comes from to the normal
};

Within within_fiber(Huang hair, vec3 direction, float gamma) {
    vec3 normal = scale_normal(-hair.tilt, gamma, hair.aspect);
    return Within(direction, gamma, normal, scale_normal(0.0, gamma, hair.aspect), dot(-direction, normal));
}

Within behind_facet(Huang hair, vec3 direction, float gamma) {
    float azimuth = ellipse_azimuth(atan(direction.x, direction.z), hair.aspect);
    return within_fiber(hair, direction, 2.0 * azimuth - gamma);
}

// gamma, before: of where the path before it came in, and that path.
Within behind_reflection(Huang hair, vec3 h, float gamma, Within before) {
    vec3 direction = reflect(before.direction, h);
    float turn = ellipse_azimuth(atan(before.direction.x, before.direction.z), hair.aspect)
                 - ellipse_azimuth(atan(-direction.x, -direction.z), hair.aspect);
    return within_fiber(hair, direction, gamma - 2.0 * turn + PI);
}

vec3 fiber_absorption(MicrofacetLobe lobe, Huang hair, vec3 direction, float gamma_a, float gamma_b) {
    return exp(-lobe.f0 * (chord(gamma_a, gamma_b, hair.aspect) / fiber_cosine(direction)));
}

// Of light within, what leaves to l.
float leave_fiber(MicrofacetLobe lobe, Huang hair, Within path, vec3 l) {
    vec3 h = l / lobe.ior - path.direction;
    float size = length(h);
    h /= size;
    float facet = dot(path.normal, h), cosine_i = dot(-path.direction, h), cosine_o = dot(-l, h);
    float value = (1.0 - fresnel_dielectric(cosine_i, 1.0 / lobe.ior)) * facet_density(hair.roughness, facet)
                  * both_masking(hair.roughness, path.cosine, dot(-l, path.normal)) * cosine_i * cosine_o
                  / (size * size) * huang_scale(hair.leaving, path.cosine) * arc_length(hair.aspect, path.gamma);
    return facet >= 0.0 && cosine_i > 0.0 && cosine_o > 0.0 ? value : 0.0;
}

// Of R, TT, TRT and the rest, what is sent from the viewer's direction to l, of one angle around the fiber.
void add_within(MicrofacetLobe lobe, Huang hair, vec3 v, vec3 l, float gamma, float weight, inout uint state,
                inout vec3 sum, inout vec3 rest) {
    vec3 m = scale_normal(hair.tilt, gamma, hair.aspect), plain = scale_normal(0.0, gamma, hair.aspect);
    vec3 h = sample_scale_facet(hair.roughness, v, m, state);
    float cosine_h = dot(v, h), cosine_m = dot(v, m), least = 1.0 / lobe.ior - 1e-5;
    Within path = behind_facet(hair, refract(-v, h, 1.0 / lobe.ior), gamma);
    float leaves = dot(-path.direction, m);
    if (!(cosine_h > 0.0) || !facet_visible(v, m, h) || !facet_visible(-path.direction, m, h)
        || !facet_visible(v, plain, h) || !facet_visible(-path.direction, plain, h))
        return;
    float transmitted = 1.0 - fresnel_dielectric(cosine_h, lobe.ior);
    float carried = transmitted * huang_scale(hair.entering, cosine_m) * other_masking(hair.roughness, cosine_m, leaves)
                    * cosine_m / leaves;
    vec3 absorbed = fiber_absorption(lobe, hair, path.direction, gamma, path.gamma + PI);
    if (dot(l, path.direction) >= least)
        sum += weight * lobe.weight.y * carried * absorbed * leave_fiber(lobe, hair, path, l);
    if (lobe.weight.z <= 0.0) return;
    vec3 h2 = sample_scale_facet(hair.roughness, -path.direction, path.normal, state);
    float cosine_2 = dot(-path.direction, h2);
    if (!(cosine_2 > 0.0)) return;
    float reflected = fresnel_dielectric(cosine_2, 1.0 / lobe.ior);
    Within next = behind_reflection(hair, h2, gamma, path);
    vec3 residual = weight * residual_of(transmitted, reflected, absorbed);
    if (dot(l, next.direction) < least) {
        rest += residual;
        return;
    }
    if (!facet_visible(-path.direction, path.normal, h2) || !facet_visible(next.direction, path.normal, h2)
        || !facet_visible(-path.direction, path.plain, h2) || !facet_visible(next.direction, path.plain, h2))
        return;
    rest += residual;
    if (!(next.cosine > 0.0) || dot(-l, next.normal) <= 0.0 || dot(-l, next.plain) <= 0.0
        || dot(-next.direction, next.plain) <= 0.0)
        return;
    float leaves_2 = dot(path.normal, next.direction);
    carried *= reflected * huang_scale(hair.leaving, path.cosine) * other_masking(hair.roughness, path.cosine, leaves_2)
               * path.cosine / leaves_2;
    sum += weight * lobe.weight.z * carried * absorbed * leave_fiber(lobe, hair, next, l)
           * fiber_absorption(lobe, hair, next.direction, next.gamma, path.gamma);
}

// The pdf is Cycles', of which nobody but its power heuristic asks: samples have their weights by themselves.
const float HUANG_PDF = 1.0;

vec3 huang_scattered(MicrofacetLobe lobe, vec3 n, vec3 wo, vec3 wi) {
    Huang hair = huang(lobe, n, wo);
    vec3 v = in_fiber(hair.frame, wo), l = in_fiber(hair.frame, wi), sum = vec3(0.0), rest = vec3(0.0);
    vec2 width = seen_width(hair), range = clamp(width, -0.999, 0.999);
    float slope = tan(hair.tilt);
    if (slope * v.y < -fiber_cosine(v) || slope * l.y < -fiber_cosine(l)) return vec3(0.0);
    uint state = fiber_state(wo, wi);
    float reflected = lobe.weight.x > 0.0 ? reflected_by_scales(lobe, hair, v, l, range, state) : 0.0;
    FiberSteps steps = fiber_steps(range, 0.8 * hair.roughness, state);
    if (lobe.weight.y > 0.0 || lobe.weight.z > 0.0)
        for (int i = 0; i <= last_step(steps); ++i) {
            float weight, gamma = fiber_step(steps, i, weight);
            add_within(lobe, hair, v, l, gamma, weight, state, sum, rest);
        }
    float along = longitudinal_pdf(vec2(l.y, fiber_cosine(l)), vec2(v.y, fiber_cosine(v)), 4.0 * hair.roughness);
    float other = largest(lobe.weight) * along / (PI * PI);
    vec3 scattered = lobe.weight.x * reflected + sum / (lobe.ior * lobe.ior) + other * rest;
    return max(scattered, 0.0) / (fiber_cosine(v) * (width.y - width.x));
}

float mean_of(vec3 v) { return (v.x + v.y + v.z) / 3.0; }

// Four ways that light may go from v, by chance: where to, and how much of it.
struct FiberWays {
    vec3 directions[4];
    vec3 carried[4];
};

vec3 residual_direction(Huang hair, vec3 v, inout uint state) {
    float w = max(fiber_random(state), 1e-5);
    float along = clamp(1.0 + 4.0 * hair.roughness * log(w + (1.0 - w) * exp(-0.5 / hair.roughness)), -1.0, 1.0);
    float sine = clamp(sqrt(1.0 - along * along) * cos(2.0 * PI * fiber_random(state)) * fiber_cosine(v) - along * v.y,
                       -1.0, 1.0);
    float phi = 2.0 * PI * fiber_random(state), cosine = sqrt(1.0 - sine * sine);
    return vec3(sin(phi) * cosine, sine, cos(phi) * cosine);
}

// TRT and the rest, of what TR has carried but for its last absorption and reflectance.
void add_reflected_within(MicrofacetLobe lobe, Huang hair, vec3 v, vec3 carried, vec3 absorbed, float transmitted,
                          Within path, Within next, inout uint state, inout FiberWays ways) {
    vec3 h = sample_scale_facet(hair.roughness, -next.direction, next.normal, state);
    float reflected = fresnel_dielectric(dot(-next.direction, h), 1.0 / lobe.ior);
    vec3 out_direction = refract(next.direction, h, lobe.ior);
    vec3 absorbed_again = fiber_absorption(lobe, hair, next.direction, next.gamma, path.gamma);
    carried *= absorbed_again * huang_scale(hair.leaving, next.cosine)
               * other_masking(hair.roughness, path.cosine, dot(path.normal, next.direction));
    bool is_visible = facet_visible(-next.direction, next.plain, h) && facet_visible(-out_direction, next.plain, h);
    if (reflected < 1.0 && is_visible)
        ways.carried[2] = lobe.weight.z * (1.0 - reflected) * carried
                          * other_masking(hair.roughness, next.cosine, dot(next.normal, -out_direction));
    ways.directions[2] = out_direction;
    vec3 mean = sqrt(absorbed * absorbed_again);
    float leaving = max(0.5 * (transmitted + 1.0 - reflected), 1e-5);
    ways.carried[3] = largest(lobe.weight) * carried * reflected * mean * leaving / (1.0 - mean * (1.0 - leaving))
                      * other_masking(hair.roughness, next.cosine, dot(next.normal, reflect(next.direction, h)));
    ways.directions[3] = residual_direction(hair, v, state);
}

FiberWays fiber_ways(MicrofacetLobe lobe, Huang hair, vec3 v, float gamma, inout uint state) {
    vec3 nothing = vec3(0.0), m = scale_normal(hair.tilt, gamma, hair.aspect),
         plain = scale_normal(0.0, gamma, hair.aspect);
    FiberWays ways = FiberWays(vec3[4](v, v, v, v), vec3[4](nothing, nothing, nothing, nothing));
    float cosine_m = dot(m, v);
    vec3 h = sample_scale_facet(hair.roughness, v, m, state);
    if (cosine_m < 0.0 || dot(plain, v) < 0.0 || !facet_visible(v, plain, h)) return ways;
    float reflected = fresnel_dielectric(dot(v, h), lobe.ior), scale = huang_scale(hair.entering, cosine_m);
    ways.directions[0] = reflect(-v, h);
    if (facet_visible(ways.directions[0], plain, h))
        ways.carried[0] = vec3(lobe.weight.x * reflected * scale
                               * other_masking(hair.roughness, cosine_m, dot(m, ways.directions[0])));
    Within path = behind_facet(hair, refract(-v, h, 1.0 / lobe.ior), gamma);
    vec3 h2 = sample_scale_facet(hair.roughness, -path.direction, path.normal, state);
    if (!(path.cosine > 0.0) || !facet_visible(-path.direction, plain, h)
        || !facet_visible(-path.direction, path.plain, h2))
        return ways;
    vec3 absorbed = fiber_absorption(lobe, hair, path.direction, gamma, path.gamma + PI);
    float reflected_2 = fresnel_dielectric(dot(-path.direction, h2), 1.0 / lobe.ior), transmitted = 1.0 - reflected_2;
    vec3 carried = (1.0 - reflected) * scale * other_masking(hair.roughness, cosine_m, dot(m, -path.direction))
                   * absorbed * huang_scale(hair.leaving, path.cosine);
    vec3 out_direction = refract(path.direction, h2, lobe.ior);
    ways.directions[1] = out_direction;
    if (transmitted > 0.0 && dot(path.normal, -out_direction) > 0.0 && facet_visible(-out_direction, path.plain, h2))
        ways.carried[1] = lobe.weight.y * transmitted * carried
                          * other_masking(hair.roughness, path.cosine, dot(path.normal, -out_direction));
    Within next = behind_reflection(hair, h2, gamma, path);
    if (next.cosine > 0.0)
        add_reflected_within(lobe, hair, v, carried * reflected_2, absorbed, transmitted, path, next, state, ways);
    return ways;
}

// A direction, and what is scattered over the pdf.
vec3 sample_huang(MicrofacetLobe lobe, vec3 n, vec3 wo, vec2 u, float uc, out vec3 weight) {
    Huang hair = huang(lobe, n, wo);
    uint state = fiber_state(wo, vec3(u, uc));
    float h = hair.coverage < 1.0 ? hair.h : 2.0 * u.x - 1.0;
    FiberWays ways = fiber_ways(lobe, hair, in_fiber(hair.frame, wo), -asin(h), state);
    vec4 weights;
    for (int p = 0; p < 4; ++p) weights[p] = mean_of(ways.carried[p]);
    float total = weights.x + weights.y + weights.z + weights.w;
    weight = vec3(0.0);
    if (!(total > 0.0)) return n;
    uc *= total;
    int p = 0;
    while (p < 3 && uc >= weights[p]) uc -= weights[p++];
    weight = ways.carried[p] * (total / max(weights[p], 1e-20));
    vec3 local = ways.directions[p];
    return normalize(local.x * hair.frame.side + local.y * hair.frame.tangent + local.z * hair.frame.across);
}

vec3 huang_albedo(MicrofacetLobe lobe, float cosine) {
    float sine2 = (1.0 - cosine * cosine) / (lobe.ior * lobe.ior);
    vec3 transmitted = exp(-lobe.f0 * (2.0 * sqrt(max(1.0 - sine2, 0.0))));
    float reflected = fresnel_dielectric(cosine, lobe.ior);
    vec3 part = (1.0 - reflected) * (1.0 - reflected) * transmitted;
    return lobe.weight.x * reflected + lobe.weight.y * part + lobe.weight.z * part * transmitted * reflected
           + largest(lobe.weight) * part * transmitted * transmitted * reflected * reflected
                 / max(1.0 - transmitted * reflected, 1e-6);
}
