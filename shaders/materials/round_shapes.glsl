// SPDX-License-Identifier: GPL-3.0-or-later
// Strands and points: what is hit is a tube of few sides, or a sphere of triangles, and what is shaded is round, as the
// viewer sees it. Only materials that are on such shapes include this.
#define ROUND_SHAPES

#include <MeshShapes>

bool is_strand(Surface surface) {
    return surface.triangle != NO_TRIANGLE && shading_instances[surface.instance].shape == SHAPE_STRANDS;
}

bool is_point(Surface surface) {
    return surface.triangle != NO_TRIANGLE && shading_instances[surface.instance].shape == SHAPE_POINTS;
}

// A place on a strand. The normal is h * side + sqrt(1 - h * h) * across.
struct Strand {
    vec3 tangent;  // unit, toward the tip
    float h;       // -1 to 1 across the strand as it is seen; Cycles' hair BSDFs call it -h
    vec3 side;     // unit, cross(tangent, across)
    float radius;  // of the round strand, meters
    vec3 across;   // unit, the viewer's direction laid across the strand
};

vec3 corner_normal(uint triangle, int corner) {
    TriangleAttributes at = attributes[triangle];
    return unpack_unit_vector(corner == 0 ? at.normal0 : corner == 1 ? at.normal1 : at.normal2);
}

// A strand's triangles have one corner, the first, that is alone on its ring of the tube. Normals of vertices are
// their places on the ring, in units of how far they lie from the axis.
Strand strand_at(Surface surface) {
    vec3 lone = corner_normal(surface.triangle, 0);
    vec3 twin = corner_normal(surface.triangle, 1), other = corner_normal(surface.triangle, 2);
    float lone_part = surface.barycentrics.x, other_part = surface.barycentrics.z;
    vec3 v0, v1, v2;
    triangle_points(surface.triangle, v0, v1, v2);
    vec3 along = v0 - v1;
    if (dot(lone, other) > dot(lone, twin)) {  // instances that are mirrored have the corners the other way round
        vec3 swapped = twin;
        twin = other;
        other = swapped;
        other_part = surface.barycentrics.y;
        along = v0 - v2;
    }
    // The tangent at the ring of two corners, and at the other one as on an arc of a circle between them.
    vec3 start = normalize(cross(twin, other));
    if (dot(start, along) < 0.0) start = -start;
    vec3 middle = twin + lone;
    along -= middle * (dot(along, middle) / max(dot(middle, middle), 1e-20));  // tubes that narrow
    float size = length(along);
    vec3 chord = size > 0.0 ? along / size : start;
    vec3 tangent = normalize(mix(start, 2.0 * dot(chord, start) * chord - start, lone_part));
    // Triangles of even number have their lone corner toward the tip.
    uint local = attributes[surface.triangle].mesh_triangle;

    Strand strand;
    strand.tangent = (local & 1u) == 0u ? tangent : -tangent;
    strand.across = surface.viewer - dot(surface.viewer, strand.tangent) * strand.tangent;
    float sine = length(strand.across);
    strand.across = sine > 1e-6 ? strand.across / sine : normalize(twin - dot(twin, tangent) * tangent);
    strand.side = cross(strand.tangent, strand.across);
    // Where the outline of the polygon begins and ends, as the viewer sees it, by the angles of its corners next to
    // either end: what is hit in between is spread evenly over the round strand's width.
    vec3 moved = lone_part * (lone - twin), a = normalize(twin + moved), b = normalize(other + moved);
    float angle = acos(clamp(dot(a, b), -1.0, 1.0)), sides = round(2.0 * PI / max(angle, 0.1)), step = 2.0 * PI / sides;
    strand.radius = length(v2 - v1) * sides / (2.0 * PI);
    float to_end = atan(dot(cross(a, strand.side), strand.tangent), dot(a, strand.side)), to_start = to_end + PI;
    float high = cos(to_end - step * round(to_end / step)), low = -cos(to_start - step * round(to_start / step));
    float place = mix(dot(a, strand.side), dot(b, strand.side), other_part);
    strand.h = clamp(2.0 * (place - low) / max(high - low, 1e-6) - 1.0, -1.0, 1.0);
    return strand;
}

vec3 strand_normal(Strand strand) {
    return strand.h * strand.side + sqrt(max(1.0 - strand.h * strand.h, 0.0)) * strand.across;
}

vec3 point_normal(Surface surface) {
    vec3 place = triangle_normal(surface.triangle, surface.barycentrics);
    // How finely the sphere is divided tells how far out, in units of its radius, its vertices lie.
    float edge = acos(clamp(dot(corner_normal(surface.triangle, 0), corner_normal(surface.triangle, 1)), -1.0, 1.0));
    place *= SPHERE_REACHES[edge > 0.8 ? 0 : edge > 0.4 ? 1 : edge > 0.2 ? 2 : 3];
    vec3 offset = place - dot(place, surface.viewer) * surface.viewer;
    float squared = min(dot(offset, offset), 1.0);
    return normalize(offset + sqrt(1.0 - squared) * surface.viewer);
}

// Strands have their own tangent wherever a surface's is asked for.
vec3 tangent_of_shape(Surface surface) {
    return is_strand(surface) ? strand_at(surface).tangent : default_tangent(surface);
}
#define default_tangent tangent_of_shape

// The normals of what the triangles stand for; rays see it from outside only.
void make_round(inout Surface surface) {
    bool strand = is_strand(surface);
    if (!strand && !is_point(surface)) return;
    vec3 normal = strand ? strand_normal(strand_at(surface)) : point_normal(surface);
    float cosine = dot(normal, surface.viewer);
    if (cosine < 1e-3) normal = normalize(normal + (1e-3 - cosine) * surface.viewer);
    surface.normal = surface.geometric = normal;
    surface.backfacing = false;
}
