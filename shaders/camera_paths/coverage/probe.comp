#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint: TRAVERSAL=deep_cubemap/traverse.glsl
// lint: TRAVERSAL=deep_cubemap/traverse.glsl TEXEL_BUFFERS=1
// lint: TRAVERSAL=bvh/traverse.glsl
// lint: TRAVERSAL=bvh/traverse_two_levels.glsl
// lint: TRAVERSAL=deep_cubemap/traverse_two_levels.glsl
// How much of the disk in which global photons count lies on surfaces, where a gathering ray ends: short rays across
// the disk, until one meets surface. Their number has the mean 1 / part (Booth, Unbiased Monte Carlo Estimation of the
// Reciprocal of an Integral, 2007), which is what the photons there have to be multiplied by.

layout(local_size_x = 64) in;

#include <CoverageParameters>
#include <Coverage>
#include "common/iteration.glsl"
#include "common/active_paths.glsl"
#include "common/sampling.glsl"
#include "common/random.glsl"
#include "common/photon.glsl"
#include "common/gathering.glsl"
#include "common/surface_tolerance.glsl"
uniform Parameters { CoverageParameters parameters; };
#include TRAVERSAL

buffer Importons;
readonly buffer Closures;

const uint MAX_LAYERS = 4u;
const float FLAT = 0.99;

struct Disk {
    vec3 center;
    vec3 normal;
    float radius;
    uint triangle;
};

// Importons of the group that need rays: most see their own triangle, and the others stand side by side.
shared uint pending[64];
shared uint pending_count;

Disk disk_of(uint index) {
    float minimum = importons[index].minimum_radius, maximum = importons[index].radius;
    float radius = photon_radius(PHOTON_AFTER_ROUGH_BOUNCE, minimum, maximum, iteration.wide_radius);
    return Disk(importons[index].position, unpack_unit_vector(importons[index].geometric_normal), radius,
                closures[index].triangle);
}

// A point of the disk, as often as the kernel of density_estimate is high there.
vec3 point_on(Disk disk, inout RandomSequence random) {
    vec3 t, b;
    tangent_frame(disk.normal, t, b);
    float distance = disk.radius * sqrt(1.0 - sqrt(1.0 - next_random(random))), angle = 2.0 * PI * next_random(random);
    return disk.center + distance * (cos(angle) * t + sin(angle) * b);
}

float kernel(Disk disk, vec3 point) {
    vec3 offset = (point - disk.center) / disk.radius;
    return max(1.0 - dot(offset, offset), 0.0);
}

vec3 plain_normal(uint triangle) {
    vec3 corner = triangle_vertex(3u * triangle).xyz;
    return cross(triangle_vertex(3u * triangle + 1u).xyz - corner, triangle_vertex(3u * triangle + 2u).xyz - corner);
}

bool is_beside(vec3 point, vec3 from, vec3 to, vec3 across) {
    return dot(cross(to - from, point - from), across) < 0.0;
}

// Whether the importon's own triangle holds the point.
bool is_on_triangle(Disk disk, vec3 point) {
    vec3 v0 = triangle_vertex(3u * disk.triangle).xyz, v1 = triangle_vertex(3u * disk.triangle + 1u).xyz,
         v2 = triangle_vertex(3u * disk.triangle + 2u).xyz, across = cross(v1 - v0, v2 - v0);
    return !(is_beside(point, v0, v1, across) || is_beside(point, v1, v2, across) || is_beside(point, v2, v0, across));
}

// The area of surfaces above and below the point that take photons as the importon does, over that of the disk there,
// weighted by the kernel.
float covered(Disk disk, vec3 point) {
    if (is_on_triangle(disk, point)) return 1.0;
    float height = PHOTON_PLANE_TOLERANCE * disk.radius, left = 2.0 * height, sum = 0.0;
    vec3 at = point + height * disk.normal;
    uint source = NO_TRIANGLE;
    // What lies behind the first layer below the importon's plane is shut off (is_shut_off).
    for (uint layer = 0u; layer < MAX_LAYERS && sum < FLAT && left >= height; ++layer) {
        Hit hit = nearest_hit(Ray(at, source, -disk.normal, left));
        if (hit.triangle == NO_TRIANGLE) break;
        source = hit.triangle;
        at -= hit.distance * disk.normal;
        left -= hit.distance;
        vec3 across = plain_normal(source);
        float cosine = abs(dot(across, disk.normal)) / max(length(across), 1e-30);
        if (cosine >= PHOTON_NORMAL_TOLERANCE) sum += kernel(disk, at) / (max(kernel(disk, point), 1e-6) * cosine);
    }
    return sum;
}

RandomSequence random_of(uint index) {
    return random_sequence(iteration.seed, iteration.number, STAGE_COVERAGE, parameters.segment,
                           parameters.first_pixel + index);
}

bool takes_global_photons(uint index) {
    return importons[index].radius > 0.0
           && (importons[index].gathers & (FINAL_GATHER_HIT | FINAL_GATHER_ORIGIN)) == FINAL_GATHER_HIT;
}

void main() {
    uint index = active_path(), thread = gl_LocalInvocationIndex;
    if (thread == 0u) pending_count = 0u;
    barrier();
    if (index != NO_PATH && takes_global_photons(index)) {
        Disk disk = disk_of(index);
        RandomSequence random = random_of(index);
        if (!is_on_triangle(disk, point_on(disk, random))) pending[atomicAdd(pending_count, 1u)] = index;
    }
    barrier();
    if (thread >= pending_count) return;
    index = pending[thread];
    Disk disk = disk_of(index);
    RandomSequence random = random_of(index);
    uint count = 0u;
    bool accepted = false;
    while (!accepted && count < MAX_PROBES) {
        ++count;
        float part = covered(disk, point_on(disk, random));
        accepted = part >= 1.0 || next_random(random) < part;
    }
    importons[index].gathers |= count << PHOTON_FACTOR_SHIFT;
}
