// SPDX-License-Identifier: GPL-3.0-or-later
// Analytic scenes with one medium and one light, and what all estimators ask them.
// SCENE: 0 a sphere lamp in fog, 1 a disk lamp above a glass ball in fog, 2 a cloud under the sun.
const float PI = 3.14159265358979;
const vec3 EYE = vec3(0.0, 0.0, 3.6);
const float TANGENT = 0.4; // of half the vertical angle of view; the camera looks along -z
const int NOTHING = 0, BLACK = 1, GLASS = 2, LAMP = 3;
const float FAR = 1e9;
const float OFFSET = 1e-4;
#if SCENE == 0
const vec3 LAMP_CENTER = vec3(-0.5, 0.45, 0.0), BALL = vec3(0.35, 0.0, 0.1);
const float LAMP_RADIUS = 0.08, BALL_RADIUS = 0.25;
const float LAMP_AREA = 4.0 * PI * LAMP_RADIUS * LAMP_RADIUS;
#elif SCENE == 1
const vec3 LAMP_CENTER = vec3(0.0, 0.92, 0.0), BALL = vec3(0.0, 0.3, 0.0);
const float LAMP_RADIUS = 0.04, BALL_RADIUS = 0.3, IOR = 1.7;
const float LAMP_AREA = PI * LAMP_RADIUS * LAMP_RADIUS;
#else
const vec3 SUN = normalize(vec3(-0.5, -0.8, -0.3)); // the way that light goes
layout(binding = 0) uniform sampler3D densities; // of the cube that holds the unit ball, majorant 1
#endif
#if SCENE < 2
const vec3 BOX = vec3(1.4, 1.0, 1.0);
const float RADIANCE = 1.0 / (PI * LAMP_AREA); // a power of one watt
#endif

uniform uint iteration, run_seed;
uniform vec2 jitter; // in pixels
uint random_state;

uint permute(uint state) { // PCG
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

float random() {
    random_state = random_state * 747796405u + 2891336453u;
    return (float(permute(random_state) >> 8u) + 0.5) / 16777216.0;
}

void seed(uint index) {
    random_state = permute(index + permute(iteration + permute(run_seed)));
}

float extinction(vec3 position) {
#if SCENE == 2
    return dot(position, position) < 1.0 ? MAJORANT * textureLod(densities, 0.5 + 0.5 * position, 0.0).r : 0.0;
#else
    return MAJORANT;
#endif
}

// The roots of a sphere: x < y, or x > y where the line misses it.
vec2 sphere_interval(vec3 from, vec3 along, vec3 center, float radius) {
    vec3 to = from - center;
    float b = dot(to, along), d = b * b - dot(to, to) + radius * radius;
    return d > 0.0 ? vec2(-b - sqrt(d), -b + sqrt(d)) : vec2(1.0, -1.0);
}

vec2 medium_interval(vec3 from, vec3 along) {
#if SCENE == 2
    vec2 t = sphere_interval(from, along, vec3(0.0), 1.0);
    return t.x < t.y ? vec2(max(t.x, 0.0), t.y) : vec2(0.0, -1.0);
#else
    vec3 a = (-BOX - from) / along, b = (BOX - from) / along;
    vec3 low = min(a, b), high = max(a, b);
    return vec2(max(max(low.x, low.y), max(low.z, 0.0)), min(high.x, min(high.y, high.z)));
#endif
}

int surface_hit(vec3 from, vec3 along, out float t) {
    t = FAR;
    int kind = NOTHING;
#if SCENE < 2
    vec2 ball = sphere_interval(from, along, BALL, BALL_RADIUS);
    float near = ball.x > OFFSET ? ball.x : ball.y;
    if (ball.x < ball.y && near > OFFSET) {
        t = near;
        kind = SCENE == 1 ? GLASS : BLACK;
    }
#endif
#if SCENE == 0
    vec2 lamp = sphere_interval(from, along, LAMP_CENTER, LAMP_RADIUS);
    if (lamp.x < lamp.y && lamp.x > OFFSET && lamp.x < t) {
        t = lamp.x;
        kind = LAMP;
    }
#elif SCENE == 1
    float disk = (LAMP_CENTER.y - from.y) / along.y;
    if (disk > OFFSET && disk < t && distance(from + disk * along, LAMP_CENTER) < LAMP_RADIUS) {
        t = disk;
        kind = LAMP;
    }
#endif
    return kind;
}

float phase(float cosine) {
    return (1.0 - G * G) / (4.0 * PI * pow(1.0 + G * G - 2.0 * G * cosine, 1.5));
}

vec3 around(vec3 axis, float cosine, float angle) {
    vec3 x = normalize(abs(axis.x) > 0.5 ? cross(axis, vec3(0, 1, 0)) : cross(axis, vec3(1, 0, 0)));
    float sine = sqrt(max(0.0, 1.0 - cosine * cosine));
    return normalize(axis * cosine + sine * (x * cos(angle) + cross(axis, x) * sin(angle)));
}

vec3 sample_phase(vec3 along) {
    float s = (1.0 - G * G) / (1.0 + G - 2.0 * G * random());
    float cosine = (1.0 + G * G - s * s) / (2.0 * G);
    return around(along, clamp(cosine, -1.0, 1.0), 2.0 * PI * random());
}

// The distance to a collision in an interval, or FAR.
float sample_distance(vec3 from, vec3 along, vec2 interval) {
    float t = interval.x;
    for (int i = 0; i < 4096; ++i) {
        t -= log(random()) / MAJORANT;
        if (t >= interval.y) return FAR;
#if SCENE == 2
        if (random() * MAJORANT < extinction(from + t * along))
#endif
            return t;
    }
    return FAR;
}

float transmittance(vec3 from, vec3 along, vec2 interval) {
#if SCENE == 2
    float result = 1.0, t = interval.x;
    for (int i = 0; i < 4096; ++i) { // ratio tracking
        t -= log(random()) / MAJORANT;
        if (t >= interval.y) break;
        result *= 1.0 - extinction(from + t * along) / MAJORANT;
        if (result < 0.05) { // roulette
            if (random() < 0.5) return 0.0;
            result *= 2.0;
        }
    }
    return result;
#else
    return exp(-MAJORANT * max(0.0, interval.y - interval.x));
#endif
}

// Reflects or refracts at the ball by Fresnel's equations.
vec3 sample_glass(vec3 along, vec3 normal, inout bool inside) {
#if SCENE == 1
    float eta = inside ? IOR : 1.0 / IOR, i = -dot(along, normal), squared = 1.0 - eta * eta * (1.0 - i * i);
    if (squared > 0.0) {
        float t = sqrt(squared);
        float s = (eta * i - t) / (eta * i + t), p = (i - eta * t) / (i + eta * t);
        if (random() >= 0.5 * (s * s + p * p)) {
            inside = !inside;
            return normalize(eta * along + (eta * i - t) * normal);
        }
    }
#endif
    return reflect(along, normal);
}

// Radiance that the light itself scatters at a point toward -along, per scattering coefficient.
float direct_light(vec3 from, vec3 along) {
    float t;
#if SCENE == 2
    vec2 interval = medium_interval(from, -SUN);
    return phase(dot(-SUN, along)) * transmittance(from, -SUN, interval);
#else
#if SCENE == 0
    vec3 to = LAMP_CENTER - from;
    float far = length(to), least = sqrt(max(0.0, 1.0 - LAMP_RADIUS * LAMP_RADIUS / (far * far)));
    vec3 toward = around(to / far, mix(least, 1.0, random()), 2.0 * PI * random());
    float factor = 2.0 * PI * (1.0 - least) * RADIANCE;
#else
    float r = LAMP_RADIUS * sqrt(random()), angle = 2.0 * PI * random();
    vec3 to = LAMP_CENTER + r * vec3(cos(angle), 0.0, sin(angle)) - from;
    vec3 toward = normalize(to);
    float factor = LAMP_AREA * max(0.0, toward.y) / dot(to, to) * RADIANCE;
#endif
    if (factor <= 0.0 || surface_hit(from, toward, t) != LAMP) return 0.0;
    return factor * phase(dot(toward, along)) * exp(-MAJORANT * t);
#endif
}

vec3 camera_ray(vec2 pixel) {
    vec2 screen = 2.0 * pixel / vec2(WIDTH, HEIGHT) - 1.0;
    return normalize(vec3(screen * TANGENT * vec2(float(WIDTH) / float(HEIGHT), 1.0), -1.0));
}

struct Photon {
    vec4 position_power; // a beam's begin, and the power there
    vec4 direction_other; // a beam's length; 1 / extinction at a photon
};
