// SPDX-License-Identifier: GPL-3.0-or-later
// Traces photons through the medium and stores their collisions (BEAMS 0), or their segments, up to the collision (1)
// or as far as the medium goes (2).
layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer Photons { Photon photons[]; };
layout(std430, binding = 1) buffer Counter { uint stored; };
uniform uint paths;

void store(vec3 position, float power, vec3 direction, float other) {
    uint index = atomicAdd(stored, 1u);
    if (index < uint(photons.length())) photons[index] = Photon(vec4(position, power), vec4(direction, other));
}

void emit(out vec3 position, out vec3 along, out float power) {
    power = 1.0;
#if SCENE == 0
    vec3 normal = around(vec3(0, 1, 0), 1.0 - 2.0 * random(), 2.0 * PI * random());
    position = LAMP_CENTER + LAMP_RADIUS * normal;
    along = around(normal, sqrt(random()), 2.0 * PI * random());
#elif SCENE == 1
    float r = LAMP_RADIUS * sqrt(random()), angle = 2.0 * PI * random();
    position = LAMP_CENTER + r * vec3(cos(angle), 0.0, sin(angle));
    vec3 to = BALL - position; // half of the photons are guided to the ball
    float far = length(to), least = sqrt(1.0 - BALL_RADIUS * BALL_RADIUS / (far * far));
    bool guided = random() < 0.5;
    along = guided ? around(to / far, mix(least, 1.0, random()), 2.0 * PI * random())
                   : around(vec3(0, -1, 0), sqrt(random()), 2.0 * PI * random());
    float cosine = max(0.0, -along.y), cone = dot(along, to / far) > least ? 0.5 / (2.0 * PI * (1.0 - least)) : 0.0;
    power = cosine / PI / (0.5 * cosine / PI + cone);
#else
    along = SUN;
    position = -2.0 * SUN + sqrt(random()) * around(SUN, 0.0, 2.0 * PI * random());
    power = PI;
#endif
    power /= float(paths);
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= paths) return;
    seed(index + 1000003u);
    vec3 position, along;
    float power, end;
    emit(position, along, power);
    bool inside = false, counts = DIRECT == 1;
    for (int i = 0; i < 200; ++i) {
        int kind = surface_hit(position, along, end);
        vec2 interval = medium_interval(position, along);
        interval.y = min(interval.y, end);
        if (!inside && interval.y > interval.x) {
            float t = sample_distance(position, along, interval);
            if (counts && BEAMS > 0) {
                float until = BEAMS == 2 ? interval.y : min(t, interval.y);
                store(position + interval.x * along, power, along, until - interval.x);
            }
            if (t < FAR) {
                position += t * along;
                if (counts && BEAMS == 0) store(position, power * ALBEDO, along, 1.0 / extinction(position));
                if (random() >= ALBEDO) return;
                along = sample_phase(along);
                counts = true;
                continue;
            }
        }
        if (kind != GLASS) return;
#if SCENE == 1
        position += end * along;
        vec3 normal = (position - BALL) / BALL_RADIUS * (inside ? -1.0 : 1.0);
        along = sample_glass(along, normal, inside);
        counts = true; // shadow rays end at glass
#endif
    }
}
