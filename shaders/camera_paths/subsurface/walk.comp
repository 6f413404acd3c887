#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint: TRAVERSAL=deep_cubemap/traverse.glsl
// lint: TRAVERSAL=deep_cubemap/traverse.glsl TEXEL_BUFFERS=1
// lint: TRAVERSAL=bvh/traverse.glsl
// lint: TRAVERSAL=bvh/traverse_two_levels.glsl
// lint: TRAVERSAL=deep_cubemap/traverse_two_levels.glsl
// Some steps of random walks below surfaces, as Cycles takes them: directions and distances are guided to the surface
// where the walk went in, or to an opposite one that is near.
// Krivanek and d'Eon, A Zero-Variance-Based Sampling Scheme for Monte Carlo Subsurface Scattering (2014).
// Meng, Hanika and Dachsbacher, Improving the Dwivedi Sampling Scheme (2016).
// D'Eon and Krivanek, Zero-Variance Theory for Efficient Subsurface Scattering (2020).

layout(local_size_x = 64) in;

#include <WalkParameters>
#include <SubsurfaceWalk>
#include "common/iteration.glsl"
#include "common/active_paths.glsl"
#include "common/sampling.glsl"
#include "common/random.glsl"
uniform Parameters { WalkParameters parameters; };
readonly buffer Attributes;
#define TRACES_INSTANCES
#include TRAVERSAL

writeonly buffer ExitHits;
buffer SubsurfaceWalks;
buffer WalkRays;

// From this step on scattering is even, by similarity.
const uint EVEN_STEPS = 10u;
// Less than this comes out of no walk that goes on.
const float LEAST_THROUGHPUT = 1e-6;

struct Medium {
    vec3 extinction;
    vec3 scattering;
    float anisotropy;
    float guided;
};

Medium medium_of(SubsurfaceWalk walk, uint step) {
    vec3 scattering = walk.extinction * walk.albedo;
    float g = walk.anisotropy;
    if (step < EVEN_STEPS) return Medium(walk.extinction, scattering, g, 1.0 - max(0.5, pow(abs(g), 0.125)));
    return Medium(walk.extinction - scattering * g, scattering * (1.0 - g), 0.0, 0.75);
}

float phase_pdf(float cosine, float g) {
    float base = 1.0 + g * g - 2.0 * g * cosine;
    return (1.0 - g * g) / (4.0 * PI * base * sqrt(base));
}

float sample_phase(float g, float u) {
    if (abs(g) < 1e-3) return 1.0 - 2.0 * u;
    float ratio = (1.0 - g * g) / (1.0 - g + 2.0 * g * u);
    return (1.0 + g * g - ratio * ratio) / (2.0 * g);
}

// Lengths are in mean free paths. v: how far light gets (d'Eon and Krivanek, eq. 67).
struct Guide {
    float v;
    float logarithm;
};

Guide guide_of(SubsurfaceWalk walk) {
    float albedo = largest(walk.albedo);
    float v = inversesqrt(1.0 - pow(albedo, 2.44294 - 0.0215813 * albedo + 0.578637 / albedo));
    return Guide(v, log((v + 1.0) / (v - 1.0)));
}

// How a step was chosen beside plain sampling: over that, of directions to the surface and away from it.
struct Guided {
    float to_surface;
    float away;
    float stretch;
    float stretch_away;
    float away_probability;
};

// A new direction; returns by what factor its extinction is stretched.
float turn(SubsurfaceWalk walk, Medium medium, Guide guide, inout Ray ray, inout RandomSequence random,
           out Guided guided) {
    vec3 normal = unpack_unit_vector(walk.normal), extinction = medium.extinction;
    float per_meter = min(extinction.x, min(extinction.y, extinction.z)) / guide.v;
    bool is_guided = next_random(random) < medium.guided;
    float depth = clamp(dot(walk.entry - ray.origin, normal), 0.0, max(walk.opposite, 0.0));
    guided.away_probability = walk.opposite < 0.0 ? 0.0 : 1.0 / (1.0 + exp((walk.opposite - 2.0 * depth) * per_meter));
    bool away = next_random(random) < guided.away_probability;
    vec2 u = next_random2(random);
    float cosine = guide.v - (guide.v + 1.0) * exp(-u.x * guide.logarithm);
    vec3 direction = is_guided ? direction_around(normal, away ? -cosine : cosine, u.y)
                               : direction_around(ray.direction, sample_phase(medium.anisotropy, u.x), u.y);
    cosine = dot(direction, normal);
    float plain = 2.0 * PI * phase_pdf(dot(ray.direction, direction), medium.anisotropy) * guide.logarithm;
    guided.to_surface = 1.0 / (plain * (guide.v - cosine));
    guided.away = 1.0 / (plain * (guide.v + cosine));
    guided.stretch = 1.0 - cosine / guide.v;
    guided.stretch_away = 1.0 + cosine / guide.v;
    ray.direction = direction;
    return is_guided ? (away ? guided.stretch_away : guided.stretch) : 1.0;
}

// Of a distance, or of more than that.
vec3 distance_pdf(vec3 extinction, float distance, bool leaves) {
    vec3 transmittance = exp(-extinction * distance);
    return leaves ? transmittance : extinction * transmittance;
}

// Walks to the next scattering, or out. False where it ends without coming out.
bool step_on(uint step, inout SubsurfaceWalk walk, inout Ray ray, inout RandomSequence random, out Hit hit) {
    Medium medium = medium_of(walk, step);
    vec3 weights = abs(walk.throughput * walk.albedo);
    vec3 channels = weights / (weights.x + weights.y + weights.z);
    float u = next_random(random);
    float extinction = u < channels.x                ? medium.extinction.x
                       : u < channels.x + channels.y ? medium.extinction.y
                                                     : medium.extinction.z;
    float u_distance = next_random(random);
    Guided guided = Guided(0.0, 0.0, 1.0, 1.0, 0.0);
    if (step > 0u) extinction *= turn(walk, medium, guide_of(walk), ray, random, guided);
    float distance = -log(1.0 - u_distance) / extinction;
    ray.maximum_distance = distance;
    vec3 most = medium.extinction;
    if (step == 0u) ray.maximum_distance = max(distance, 10.0 / min(most.x, min(most.y, most.z)));
    hit = nearest_hit(ray);
    bool leaves = hit.triangle != NO_TRIANGLE;
    if (step == 0u && leaves) {
        walk.opposite = max(-hit.distance * dot(ray.direction, unpack_unit_vector(walk.normal)), 0.0);
        leaves = hit.distance < distance;
    }
    if (leaves) distance = hit.distance;
    else hit.triangle = NO_TRIANGLE;
    vec3 pdf = distance_pdf(medium.extinction, distance, leaves), transmittance = exp(-medium.extinction * distance);
    if (step > 0u) {
        vec3 to_surface = guided.to_surface * distance_pdf(guided.stretch * medium.extinction, distance, leaves),
             away = guided.away * distance_pdf(guided.stretch_away * medium.extinction, distance, leaves);
        pdf = mix(pdf, mix(to_surface, away, guided.away_probability), medium.guided);
    }
    walk.throughput *= (leaves ? transmittance : medium.scattering * transmittance) / dot(channels, pdf);
    ray.origin += distance * ray.direction;
    ray.source_triangle = NO_TRIANGLE;
    if (!is_finite(walk.throughput)) {
        hit.triangle = NO_TRIANGLE;
        return false;
    }
    return largest(walk.throughput) >= LEAST_THROUGHPUT;
}

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    SubsurfaceWalk walk = subsurface_walks[index];
    Ray ray = walk_rays[index];
    if (parameters.first_step == 0u) walk.instance = attributes[ray.source_triangle].instance;
    traced_instance = walk.instance;
    begin_path(parameters.first_hit + 2u * index);
    RandomSequence start = random_sequence(iteration.seed, iteration.number, parameters.stage, parameters.segment,
                                           parameters.first_path + index);
    Hit hit = Hit(NO_TRIANGLE, 0.0, 0.0, 0.0);
    bool goes_on = true;
    for (uint step = parameters.first_step; goes_on && step < parameters.end_step; ++step) {
        RandomSequence random = start;
        random.key.w += 2u * step + 2u;
        goes_on = step_on(step, walk, ray, random, hit) && hit.triangle == NO_TRIANGLE;
    }
    ray.maximum_distance = goes_on ? 1.0 : 0.0;
    subsurface_walks[index] = walk;
    walk_rays[index] = ray;
    exit_hits[index] = hit;
}
