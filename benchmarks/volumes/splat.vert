// SPDX-License-Identifier: GPL-3.0-or-later
// Quads that cover what photons (SPLAT 1) or beams (2) reach on the screen; points of one pixel (0: light tracing).
layout(std430, binding = 0) readonly buffer Photons { Photon photons[]; };
uniform float radius;
flat out vec4 begin_power;
flat out vec4 direction_other;
const vec2 CORNERS[6] = vec2[](vec2(-1, -1), vec2(1, -1), vec2(-1, 1), vec2(-1, 1), vec2(1, -1), vec2(1, 1));

vec2 project(vec3 position) {
    vec3 to = position - EYE;
    return to.xy / (-to.z * TANGENT) * vec2(float(HEIGHT) / float(WIDTH), 1.0);
}

vec2 beam_corner(vec3 a, vec3 along, float len, vec2 corner) {
    vec3 b = a + len * along, to_a = a - EYE, to_b = b - EYE;
    vec3 normal = cross(to_a, along);
    float away = length(normal), cos_a = dot(normalize(to_a), along), cos_b = dot(normalize(to_b), along);
    if (max(abs(cos_a), abs(cos_b)) < 0.95 && away > 2.0 * radius) {
        // Silhouettes of the cylinder around the beam, longer by what its end disks reach along it.
        float wide = radius / sqrt(1.0 - radius * radius / (away * away)), cosine = corner.x < 0.0 ? cos_a : cos_b;
        float reach = 1.1 * radius * (abs(cosine) / sqrt(1.0 - cosine * cosine) + radius / away);
        return project((corner.x < 0.0 ? a - reach * along : b + reach * along) + corner.y * wide * normal / away);
    }
    vec2 aspect = vec2(float(WIDTH) / float(HEIGHT), 1.0), from = project(a) * aspect, to = project(b) * aspect;
    float wide = 1.2 * radius / (TANGENT * min(-to_a.z, -to_b.z)), span = distance(from, to);
    vec2 x = span > 0.0 ? (to - from) / span : vec2(1, 0), y = vec2(-x.y, x.x);
    return ((corner.x < 0.0 ? from : to) + wide * (corner.x * x + corner.y * y)) / aspect;
}

void main() {
#if SPLAT == 0
    Photon photon = photons[gl_VertexID];
    vec2 screen = project(photon.position_power.xyz);
    gl_PointSize = 1.0;
#else
    Photon photon = photons[gl_VertexID / 6];
    vec2 corner = CORNERS[gl_VertexID % 6];
#if SPLAT == 1
    vec3 to = photon.position_power.xyz - EYE;
    float wide = 1.12 * radius / (-to.z * TANGENT);
    vec2 screen = project(photon.position_power.xyz) + wide * corner * vec2(float(HEIGHT) / float(WIDTH), 1.0);
#else
    vec2 screen = beam_corner(photon.position_power.xyz, photon.direction_other.xyz, photon.direction_other.w, corner);
#endif
    screen -= 2.0 * jitter / vec2(WIDTH, HEIGHT);
#endif
    begin_power = photon.position_power;
    direction_other = photon.direction_other;
    gl_Position = vec4(screen, 0.0, 1.0);
}
