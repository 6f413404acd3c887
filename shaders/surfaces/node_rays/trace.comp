#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint: TRAVERSAL=deep_cubemap/traverse.glsl
// lint: TRAVERSAL=deep_cubemap/traverse.glsl TEXEL_BUFFERS=1
// lint: TRAVERSAL=deep_cubemap/traverse.glsl RAYCASTS=1
// lint: TRAVERSAL=bvh/traverse.glsl
// lint: TRAVERSAL=bvh/traverse.glsl RAYCASTS=1
// lint: TRAVERSAL=bvh/traverse_two_levels.glsl NODE_HITS=surfaces/node_rays/two_levels
// lint: TRAVERSAL=bvh/traverse_two_levels.glsl NODE_HITS=surfaces/node_rays/two_levels RAYCASTS=1
// lint: TRAVERSAL=deep_cubemap/traverse_two_levels.glsl NODE_HITS=surfaces/node_rays/two_levels
// lint: TRAVERSAL=deep_cubemap/traverse_two_levels.glsl NODE_HITS=surfaces/node_rays/two_levels RAYCASTS=1
// What the nodes of a program's materials ask of rays, some samples of each at a time.

layout(local_size_x = 64) in;

#include <NodeRaysParameters>
#include "common/invocation.glsl"
#include "common/low_discrepancy.glsl"
#include "common/differential_frame.glsl"
#include "common/sampling.glsl"
uniform Parameters { NodeRaysParameters parameters; };
buffer NodeRays;
readonly buffer Rays;
readonly buffer Hits;
readonly buffer Attributes;
#include "common/triangle_normal.glsl"
readonly buffer HitOrder;

#define TRACES_INSTANCES
#include TRAVERSAL
#include NODE_HITS "surfaces/node_rays/one_level/hits.glsl"
#include <NodeRayQueries>
#include <Ranges>

// Of surfaces behind one another, those up to here count for a bevel.
const int MOST_BEVEL_HITS = 4;
const vec3 AXES = vec3(0.5, 0.25, 0.25);  // probabilities of the normal and of two directions across it

// 10 (1 - r)^3 / pi for points of the disk of radius 1.
float bevel_pdf(float r) {
    float f = max(1.0 - r, 0.0);
    return 10.0 / PI * f * f * f;
}

// The radius that a fraction u of its points is within, by Newton's method.
float bevel_radius(float u) {
    float x = 0.25;
    for (int k = 0; k < 10; ++k) {
        float x2 = x * x, y = 1.0 - x, f = x2 * (10.0 - 20.0 * x + 15.0 * x2 - 4.0 * x2 * x) - u;
        float slope = 20.0 * x * y * y * y;
        if (abs(f) < 1e-6 || slope == 0.0) break;
        x = clamp(x - f / slope, 0.0, 1.0);
    }
    return x;
}

// Through the sphere around the place along one of the axes (King et al., BSSRDF Importance Sampling, SIGGRAPH 2013, as
// Cycles' bevel has it). r: how far from the center, in radii.
Ray bevel_ray(vec3 position, mat3 axes, float radius, vec2 u, out int axis, out float r) {
    axis = u.x < AXES.x ? 0 : u.x < AXES.x + AXES.y ? 1 : 2;
    float angle = 2.0 * PI * (axis == 0 ? 2.0 * u.x : 4.0 * (u.x - (axis == 1 ? 0.5 : 0.75)));
    vec3 along = axis == 0 ? axes[0] : axis == 1 ? axes[1] : axes[2];
    vec3 across = axis == 1 ? axes[0] : axes[1], other = axis == 2 ? axes[0] : axes[2];
    r = bevel_radius(u.y);
    float height = sqrt(max(1.0 - r * r, 0.0));
    vec3 from = height * along + r * (cos(angle) * across + sin(angle) * other);
    return Ray(position + radius * from, NO_TRIANGLE, -along, 2.0 * radius * height);
}

vec3 point_of(uint triangle, vec3 b) {
    return b.x * triangle_vertex(3u * triangle).xyz + b.y * triangle_vertex(3u * triangle + 1u).xyz
           + b.z * triangle_vertex(3u * triangle + 2u).xyz;
}

vec3 barycentrics(Hit hit) { return vec3(1.0 - hit.b1 - hit.b2, hit.b1, hit.b2); }

// From a triangle to where rays begin on its front.
vec3 ray_offset_of(uint triangle, vec3 normal) {
    return normal
           * ray_offset(normal, triangle_vertex(3u * triangle).xyz, triangle_vertex(3u * triangle + 1u).xyz,
                        triangle_vertex(3u * triangle + 2u).xyz);
}

vec3 geometric_normal(uint triangle) {
    vec3 v0 = triangle_vertex(3u * triangle).xyz;
    return normalize(cross(triangle_vertex(3u * triangle + 1u).xyz - v0, triangle_vertex(3u * triangle + 2u).xyz - v0));
}

// The axes: first the one around which rays go. offset: ray_offset_of the triangle.
Ray occlusion_ray(vec3 position, vec3 offset, uint triangle, mat3 axes, float reach, vec2 u) {
    vec2 d = sample_disk(u);
    vec3 direction = normalize(axes * vec3(sqrt(max(1.0 - dot(d, d), 0.0)), d));
    vec3 origin = position + (dot(direction, offset) < 0.0 ? -offset : offset);
    return Ray(origin, triangle, direction, reach);
}

// The front's.
vec3 smooth_normal(Hit hit, vec3 geometric, vec3 b) {
    vec3 normal = normal_of(hit, b);
    return dot(normal, normal) > 1e-12 ? normalize(normal) : geometric;
}

// Of where a bevel's ray hits, by its weight.
vec3 bevel_normal(Hit hit, vec3 position, mat3 axes, int axis, float radius, float r) {
    vec3 geometric = geometric_normal(hit.triangle), b = barycentrics(hit);
    vec3 normal = smooth_normal(hit, geometric, b);
    // The power heuristic between the axes.
    vec3 pdfs = AXES * abs(geometric * axes);
    float pdf = axis == 0 ? pdfs.x : axis == 1 ? pdfs.y : pdfs.z;
    float weight = pdf / max(dot(pdfs, pdfs), 1e-20);
    weight *= bevel_pdf(length(point_of(hit.triangle, b) - position) / radius) / max(bevel_pdf(r), 1e-20);
    return weight * normal;
}

#ifdef RAYCASTS
bool is_raycast(uint kind) { return kind == QUERY_RAYCAST || kind == QUERY_LOCAL_RAYCAST; }
bool meets_all(uint kind) { return kind == QUERY_OCCLUSION || kind == QUERY_RAYCAST; }

Ray cast_ray(NodeRay asked, uint beside, uint triangle) {
    uint source = (asked.query & QUERY_FROM_SURFACE) != 0u ? triangle : NO_TRIANGLE;
    return Ray(node_rays[beside].direction, source, asked.direction, asked.reach);
}

// What a Raycast finds: the normal on the ray's side, and beside it the rest.
vec3 keep_cast(uint beside, Hit hit, vec3 direction, uint instance) {
    node_rays[beside].found = vec3(0.0);
    if (hit.triangle == NO_TRIANGLE) return vec3(0.0);
    uint found_instance = instance_of(hit.triangle), found_triangle = mesh_triangle_of(hit);
    node_rays[beside].direction = vec3(hit.b1, hit.b2, float(found_triangle & 0xffffffu));
    node_rays[beside].reach = float(found_triangle >> 24u | (found_instance & 0xffffu) << 8u);
    vec3 geometric = geometric_normal(hit.triangle);
    vec3 normal = smooth_normal(hit, geometric, barycentrics(hit));
    bool itself = found_instance == instance;
    node_rays[beside].found = vec3(hit.distance, 1.0 + float(found_instance >> 16u), float(itself));
    return dot(geometric, direction) > 0.0 ? -normal : normal;
}
#else
bool meets_all(uint kind) { return kind == QUERY_OCCLUSION; }
#endif

void main() {
    uint place = invocation_index();
    if (place >= hit_order[RANGE_SIZE * parameters.program + 1u]) return;
    uint index = hit_order[hit_order[RANGE_SIZE * parameters.program] + place];
    Hit seen = hits[index];
    if (!(rays[index].maximum_distance > 0.0) || seen.triangle == NO_TRIANGLE) return;
    vec3 position = point_of(seen.triangle, barycentrics(seen));
    vec3 offset = ray_offset_of(seen.triangle, geometric_normal(seen.triangle));
    uint instance = attributes[seen.triangle].instance;
    for (uint k = 0u; k < parameters.ray_places; ++k) {
        uint at = parameters.ray_stride * index + k;
        NodeRay asked = node_rays[at];
        uint kind = asked.query & QUERY_KIND;
        if (kind == 0u || (asked.query >> QUERY_LEVEL_SHIFT & QUERY_LEVEL) != parameters.ray_level) continue;
        uint samples = asked.query >> QUERY_SAMPLES_SHIFT;
        uint end = min(parameters.first_sample + parameters.sample_count, samples);
        uvec4 set = pcg4d(uvec4(index, parameters.iteration, parameters.seed,
                                STAGE_NODE_RAYS << 24u | parameters.segment << 12u | k));
        bool bevel = kind == QUERY_BEVEL;
        traced_instance = meets_all(kind) ? ALL_INSTANCES : instance;
        mat3 axes;
        axes[0] = asked.direction;
        differential_frame(axes[0], axes[1], axes[2]);
        vec3 found = asked.found;
        for (uint number = parameters.first_sample; number < end; ++number) {
            vec2 u = scrambled_sobol(number, set);
            int axis = 0;
            float r = 0.0;
            Ray ray;
            if (bevel) ray = bevel_ray(position, axes, asked.reach, u, axis, r);
            else ray = occlusion_ray(position, offset, seen.triangle, axes, asked.reach, u);
            bool any_hit = !bevel;
#ifdef RAYCASTS
            if (is_raycast(kind)) ray = cast_ray(asked, at + 1u, seen.triangle);
            any_hit = any_hit && !is_raycast(kind);
#endif
            int most_hits = bevel ? MOST_BEVEL_HITS : 1;
            for (int hit_number = 0; hit_number < most_hits; ++hit_number) {
                Hit hit = trace_node_ray(ray, any_hit);
#ifdef RAYCASTS
                if (is_raycast(kind)) {
                    found = keep_cast(at + 1u, hit, ray.direction, instance);
                    break;
                }
#endif
                if (hit.triangle == NO_TRIANGLE) {
                    if (!bevel) found.x += 1.0;
                    break;
                }
                if (!bevel) break;
                found += bevel_normal(hit, position, axes, axis, asked.reach, r);
                ray.origin += hit.distance * ray.direction;
                ray.maximum_distance -= hit.distance;
                ray.source_triangle = hit.triangle;
            }
        }
        node_rays[at].found = found;
        if (parameters.first_sample + parameters.sample_count >= parameters.samples) node_rays[at].query = 0u;
    }
}
