#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint:
// lint: MEDIA=1
// lint: MEDIA=1 HETEROGENEOUS_MEDIA=1
// lint: HAIR_LOBES=1
// lint: ASHIKHMIN_LOBES=1
// lint: THIN_FILM_LOBES=1
// lint: PORTALS=1
// lint: TRANSPARENT_GLASS=1
// lint: RAY_PORTALS=1
// lint: MEDIA=1 RAY_PORTALS=1
// lint: COUNTS_BOUNCES=1 CLAMPS_LIGHT=1
// lint: COUNTS_BOUNCES=1 CLAMPS_LIGHT=1 FILTERS_GLOSSY=1
// lint: EMITTERS=lights/two_levels
// lint: EMITTERS=lights/two_levels MEDIA=1 HETEROGENEOUS_MEDIA=1
// TraceImportons: at the end of the ray of a camera path, add the emission along the ray, leave an importon for the
// lobes that store photons, and sample the next ray. The verbs are those of pbrt-v4's wavefront integrator.

layout(local_size_x = 64) in;

#include <ScatterImportonsParameters>
#include "common/iteration.glsl"
#include "common/active_paths.glsl"
#include "common/bsdf/closure.glsl"
#include "common/camera_path.glsl"
#include "common/gathering.glsl"
#include "common/path_history.glsl"
#include "common/world_light.glsl"
#include "camera_paths/importons/media.glsl"
#include "materials/medium.glsl"
uniform Parameters { ScatterImportonsParameters parameters; };
#include "lights/light_tree.glsl"
readonly buffer Closures;
buffer Rays;
buffer CameraPaths;
buffer Importons;
readonly buffer CatcherVisibility;
buffer FinalGatherOrigins;
buffer FinalGatherHits;
buffer Radiances;
readonly buffer RadiusFactors;
#include "camera_paths/importons/path_vertex.glsl"
#include "camera_paths/importons/emission.glsl"
#include "camera_paths/importons/environment.glsl"
#include "camera_paths/importons/leave_importon.glsl"
#include "camera_paths/importons/sample_bsdf.glsl"
#include "camera_paths/importons/sample_next_ray.glsl"

// The surface at the end of a ray: its emission, an importon, and the next ray, unless a medium scatters the path
// before.
void handle_surface(PathSegment segment, uint history, vec3 lights) {
    SurfaceVertex vertex = surface_vertex(segment, history);
    handle_emission(segment, vertex, lights);
    LobeSelection lobes = select_lobes(vertex);
    RaySamples samples = ray_samples(segment.index);
    record_final_gather_hit(vertex, lobes);
    leave_importon(vertex, lobes, samples.importon);
#ifdef MEDIA
    if (vertex.path.medium_passing == SCATTERED_BY_MEDIUM) return;
    lobes = passed_media(lobes, vertex.path.medium_passing, vertex.path.flags);
    vertex.path.throughput /= max(vertex.path.medium_passing, 1e-20);
#endif
    sample_next_ray(vertex, lobes, samples);
}

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    Ray ray = rays[index];
    uint history = begin_segment(index);
    if (!(ray.maximum_distance > 0.0)) return;
    PathSegment segment = path_segment(index, ray);
    handle_media(segment);
    vec3 lights = light_object_emission(segment);
    if (segment.escapes) handle_escaped(segment, lights);
    else handle_surface(segment, history, lights);
}
