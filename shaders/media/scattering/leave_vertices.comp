#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint: MEDIA=1
// lint: MEDIA=1 RAY_PORTALS=1
// Camera paths go on from their vertices in media by a final gather, which no neighbor reuses: their throughput is that
// of the path from the camera on. They have nothing to do with the surfaces at the ends of their rays any more.

layout(local_size_x = 64) in;

#include "common/active_paths.glsl"
#include "common/constants.glsl"
#include "common/bsdf/microfacet.glsl"
#include "common/camera_path.glsl"
#include "common/medium_vertices.glsl"
#include "common/path_depth.glsl"
#include "common/path_history.glsl"
#include <ClearGlass>
#include <FinalGather>
#include <Importon>
#include <Ray>
readonly buffer MediumVertices;
buffer Rays;
buffer CameraPaths;
buffer Importons;
writeonly buffer FinalGatherOrigins;
writeonly buffer FinalGatherHits;

void main() {
    uint index = active_path();
    if (index == NO_PATH || camera_paths[index].medium_passing != SCATTERED_BY_MEDIUM) return;
    MediumVertex vertex = medium_vertices[index];
    CameraPath path = camera_paths[index];
    camera_paths[index].medium_passing = 1.0;
    uint history = departing_history(importons[index].history);
    importons[index].history = history_word(history, history | HISTORY_AGAIN, path.depth);
    if (!(max(vertex.throughput.r, max(vertex.throughput.g, vertex.throughput.b)) > 0.0)) return;
    if ((path.flags & PATH_FINAL_GATHER) == 0u) {
        uint normal = pack_unit_vector(vertex.direction);
        final_gather_origins[index] = FinalGatherOrigin(vertex.position, 0.0, vec3(1.0), normal);
        final_gather_hits[index] = FinalGatherHit(vertex.position, normal, vec3(0.0));
    }
    const uint gone = PATH_CAMERA_TRANSPARENT | PATH_TRANSMITTED | PATH_LIGHTS_FOUND | PATH_SEEN_THROUGH | PATH_CAUSTIC
                      | PATH_BEHIND_CLEAR_GLASS;
    path.flags = (path.flags & ~gone) | PATH_DIFFUSE | PATH_SINGULAR | PATH_FINAL_GATHER;
    path.throughput = vertex.throughput;
    path.total_length += distance(rays[index].origin, vertex.position);
    path.straight_length = 0.0;
    path.scatter_pdf = vertex.phase_pdf;
    path.least_pdf = min(path.least_pdf, vertex.phase_pdf);
    path.depth += ONE_BOUNCE;
    path.bounce_counts = medium_counted(path.bounce_counts);
#ifdef RAY_PORTALS
    path.lit_from &= ~BEHIND_RAY_PORTAL;
#endif
    path.medium_passing = 1.0;
    camera_paths[index] = path;
    rays[index] = Ray(vertex.position, NO_TRIANGLE, vertex.direction, INFINITY_DISTANCE);
}
