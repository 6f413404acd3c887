// SPDX-License-Identifier: GPL-3.0-or-later
// The ray by which a camera path goes on. The includer includes camera_paths/importons/sample_bsdf.glsl before.

// Without a hit, the ray of a final gather counts as one to a point so far away, in radii, that neighboring pixels see
// it in the same direction.
const float FAR_RADII = 1e4;

// The state of a path that a BSDF sample changes, but for its throughput.
void extend_path(inout SurfaceVertex vertex, BsdfSample bsdf) {
    Closure closure = vertex.closure;
    CameraPath path = vertex.path;
    bool is_scattered = bsdf.scatter != SCATTER_NONE;
    path.flags = bsdf.flags;
    if (is_scattered) path.depth += ONE_BOUNCE;
    else if (counts_as_transparent(closure)) path.depth += ONE_TRANSPARENT;
#ifdef COUNTS_BOUNCES
    if (is_scattered) path.bounce_counts = counted(path.bounce_counts, counted_scatter(bsdf.scatter, bsdf.transmitted));
#endif
    path.straight_length = is_scattered ? 0.0 : path.straight_length + closure.distance;
#ifdef FILTERS_GLOSSY
    path.least_pdf = min(path.least_pdf, filtered_pdf);
#endif
    path.scatter_pdf = bsdf.pdf;
    if (is_scattered && bsdf.pdf > 0.0) {
        path.lit_normal = closure.shading_normal;
        path.lit_from =
            pack_lit_from(light_set_at(closure.triangle), lit_from_behind(vertex.index, closure), vertex.can_gather);
    }
#ifdef RAY_PORTALS
    note_ray_portals(path, vertex.path.lit_from);
#endif
    vertex.path = path;
}

// The ray of a final gather leaves. Neighboring pixels reuse its radiance, and each weights it by the throughput at its
// own origin: the ray itself begins white. Rough lobes see in directions of their own, so that only diffuse ones are
// reused. A secondary gather goes on from the hit of the first one, and keeps its origin.
void start_final_gather(inout SurfaceVertex vertex, BsdfSample bsdf, bool is_secondary) {
    Closure closure = vertex.closure;
    PhotonRadii radii = vertex.radii;
    vertex.path.flags &= ~(PATH_CAUSTIC | PATH_DISPERSED);
    vertex.path.photon_radius = disk_radius(radii.minimum, radii.maximum);
    if (is_secondary) {
        vertex.path.throughput *= bsdf.gather_throughput;
        return;
    }
    bool is_diffuse = (bsdf.flags & PATH_DIFFUSE) != 0u;
    final_gather_origins[vertex.index] = FinalGatherOrigin(closure.position, is_diffuse ? radii.footprint : 0.0,
                                                           vertex.path.throughput, pack_unit_vector(bsdf.normal));
    final_gather_hits[vertex.index] = FinalGatherHit(closure.position + FAR_RADII * radii.footprint * bsdf.direction,
                                                     pack_unit_vector(-bsdf.direction), vec3(0.0));
    vertex.path.throughput = bsdf.gather_throughput;
}

// Writes the path and its next ray, unless the path carries nothing or the ray would leave on the wrong side of the
// surface. Behind a shadow catcher only the environment is visible.
void spawn_ray(SurfaceVertex vertex, BsdfSample bsdf) {
    Closure closure = vertex.closure;
    vec3 geometric = unpack_unit_vector(closure.geometric_normal);
    float side = dot(bsdf.direction, geometric);
    bool is_wrong_side = bsdf.transmitted ? side >= 0.0 : side <= 0.0;
#ifdef RAY_PORTALS
    is_wrong_side = is_wrong_side && !by_ray_portal;
#endif
    if (!(largest(vertex.path.throughput) > 0.0) || is_wrong_side) return;
    if (bsdf.transmitted && may_cross(closure))
        vertex.path.flags = cross_surface(vertex.path.flags, closure.material, closure_backfacing(closure));
    camera_paths[vertex.index] = vertex.path;
    float offset = closures[vertex.index].ray_offset;
    vec3 origin = closure.position + (side > 0.0 ? offset : -offset) * geometric;
    bool catches_shadows = (closure.flags & CLOSURE_CATCHES_SHADOWS) != 0u;
    rays[vertex.index] =
        Ray(origin, closure.triangle, bsdf.direction, catches_shadows ? ESCAPING_DISTANCE : INFINITY_DISTANCE);
#ifdef RAY_PORTALS
    if (by_ray_portal) rays[vertex.index] = ray_behind_portal(vertex, origin, bsdf.direction);
#endif
}

// The path ends here by Russian roulette, begins a final gather, or goes on by the specular lobes.
void sample_next_ray(SurfaceVertex vertex, LobeSelection lobes, RaySamples samples) {
    uint index = vertex.index;
    if (lobes.total <= 0.0 || samples.lobe >= lobes.survival) return;
    float u = samples.lobe * (lobes.total / lobes.survival);
    float gather_weight = vertex.can_gather ? sum(lobes.stored) : 0.0;
    bool gathers = u < gather_weight, is_secondary = is_final_gather(vertex.path);
#ifdef RAY_PORTALS
    if (gathers) vertex.path.lit_from &= ~BEHIND_RAY_PORTAL;
#endif
#ifdef TRANSPARENT_GLASS
    if (gathers && !is_secondary) vertex.path.flags &= ~PATH_BEHIND_CLEAR_GLASS;
#endif
    if (gathers)
        vertex.path.flags = (vertex.path.flags & ~PATH_CAMERA_TRANSPARENT) | PATH_FINAL_GATHER
                            | (is_secondary ? PATH_SECONDARY_GATHER : 0u);
    else u -= gather_weight;
    BsdfSample bsdf = sample_bsdf(vertex, lobes, gathers, u, samples);
    if (bsdf.probability <= 0.0) return;
    importons[index].history =
        history_word(vertex.history, scattered_history(vertex.history, bsdf.scatter), vertex.path.depth);
    extend_path(vertex, bsdf);
    vertex.path.throughput *= bsdf.weight * (lobes.total / (bsdf.probability * lobes.survival));
    if (gathers) start_final_gather(vertex, bsdf, is_secondary);
    else if (!is_final_gather(vertex.path) && bsdf.scatter != SCATTER_NONE)
        final_gather_origins[index].position = vertex.closure.position;
    spawn_ray(vertex, bsdf);
}
