// SPDX-License-Identifier: GPL-3.0-or-later
// A camera path while it is scattered: its ray and the vertex at the ray's end. The includer declares the blocks that
// hold these before.

#include <FinalGather>
#include "common/bsdf/lobe_selection.glsl"
#include "common/low_discrepancy.glsl"
#include "common/transparency.glsl"
#include "camera_paths/importons/radius.glsl"
#include "camera_paths/last_vertex.glsl"
#include "camera_paths/importons/scatter_point.glsl"

// The ray of a camera path, from the vertex that scattered it to its hit.
struct PathSegment {
    uint index;       // of the path in its band
    CameraPath path;  // as it arrives at the end of the ray
    Ray ray;
    ScatterPoint from;       // where the ray was scattered
    bool escapes;            // to the environment
    float distance;          // to the surface; INFINITY_DISTANCE where the ray escapes
    vec3 origin_throughput;  // of the path at the origin of the ray
};

// The vertex of a camera path on a surface.
struct SurfaceVertex {
    uint index;       // of the path in its band
    CameraPath path;  // as it arrives
    Ray ray;          // that arrives
    uint history;     // PathHistory of the path as it arrives
    Closure closure;
    PhotonRadii radii;
    bool can_gather;  // whether the path may begin a final gather here
};

// Random numbers of a vertex, in [0, 1) but for the point on the unit disk.
struct RaySamples {
    float lobe;       // selects the lobe by which the path goes on, or its end
    vec2 disk;        // point on the unit disk, for the direction
    float component;  // selects reflection or transmission of the lobe
    float importon;   // selects the lobe of the importon
};

// Low-discrepancy points of the pixel's own fill each dimension evenly over the iterations: what a pixel selects seldom
// comes neither in a row nor never.
RaySamples ray_samples(uint index) {
    uvec4 scramble =
        pcg4d(uvec4(parameters.first_pixel + index, parameters.segment, iteration.seed, STAGE_IMPORTONS << 24u));
    vec4 u = scrambled_sobol4(iteration.number - 1u, scramble);
    float u_importon = scrambled_sobol(iteration.number - 1u, pcg4d(scramble)).x;
    return RaySamples(u.z, sample_disk(u.xy), u.w, u_importon);
}

// Marks that the path has no importon and no next ray until it gets them. Returns the path's history.
uint begin_segment(uint index) {
    uint history = parameters.segment == 0u ? 0u : departing_history(importons[index].history);
    importons[index].radius = 0.0;
#ifdef COUNTS_BOUNCES
    camera_paths[index].arrived_counts = camera_paths[index].bounce_counts;
#endif
    rays[index].maximum_distance = 0.0;
    if (parameters.segment == 0u) {
        final_gather_origins[index].reuse_radius = NO_FINAL_GATHER;
        importons[index].history = 0u;
    }
    return history;
}

PathSegment path_segment(uint index, Ray ray) {
    CameraPath path = camera_paths[index];
    bool escapes = closures[index].triangle == NO_TRIANGLE;
    float distance = escapes ? INFINITY_DISTANCE : closures[index].distance;
    return PathSegment(index, path, ray, scatter_point(index, path, ray), escapes, distance, path.throughput);
}

// A shadow catcher lets through what its visibility says, and transparent surfaces beyond the limit nothing.
SurfaceVertex surface_vertex(PathSegment segment, uint history) {
    uint index = segment.index;
    CameraPath path = segment.path;
    Closure closure = closures[index];
    if ((closure.flags & CLOSURE_CATCHES_SHADOWS) != 0u) path.throughput *= float(catcher_visibility[index]);
    limit_transparency(closure, path.depth, iteration.transparent_max_bounces);
#ifdef RAY_PORTALS
    if (is_last_vertex(path)) closure.flags |= CLOSURE_KEEPS_LIGHT;
#endif
    PhotonRadii radii = photon_radii(index, path, segment.ray.direction, closure);
    return SurfaceVertex(index, path, segment.ray, history, closure, radii, can_gather(path, closure));
}

// Behind its last bounce a path only passes transparent surfaces.
LobeSelection select_lobes(SurfaceVertex vertex) {
    bool is_camera_ray = (vertex.path.flags & PATH_CAMERA_TRANSPARENT) != 0u;
    LobeSelection lobes = select_lobes(vertex.index, vertex.closure, vertex.path.throughput, -vertex.ray.direction,
                                       vertex.can_gather, is_camera_ray);
    if (!is_last_vertex(vertex.path)) return lobes;
    float transparent = lobes.specular.x;
    return LobeSelection(vec4(transparent, 0.0, 0.0, 0.0), vec4(0.0), transparent,
                         survival_probability(transparent, is_camera_ray));
}
