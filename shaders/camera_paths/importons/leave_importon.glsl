// SPDX-License-Identifier: GPL-3.0-or-later
// Importons: where photons are looked up for a camera path.
// The includer includes camera_paths/importons/path_vertex.glsl before.

// One rough lobe stands for all lobes that store photons, selected by its albedo.
ClosureLobe sample_importon_lobe(SurfaceVertex vertex, vec4 weights, float u) {
    float total = 0.0;
    int selected = -1;
    for (int k = 0; k < closure_lobes(vertex.closure); ++k) {
        float weight = weights[1 + k];
        if (!(weight > 0.0)) continue;
        total += weight;
        if (reservoir_accept(weight, total, u)) selected = k;
    }
    if (selected < 0) return EMPTY_LOBE;
    vec3 throughput = vertex.path.throughput;
    ClosureLobe lobe = closures[vertex.index].lobes[max(selected, 0)];
    float weight = weights[1 + max(selected, 0)];
    lobe.weight = throughput * lobe.weight / weight * total;
    if (passes_by_f0(unpack_kind(lobe.kind))) lobe.f0 = throughput * lobe.f0 / weight * total;
    return lobe;
}

// The vertices of a path in media.
uint vertex_bits(CameraPath path) {
#ifdef MEDIA
    return medium_count(path.bounce_counts) << IMPORTON_MEDIUM_SHIFT;
#else
    return 0u;
#endif
}

uint gather_flags(SurfaceVertex vertex) {
    return vertex_bits(vertex.path) | (vertex.can_gather ? FINAL_GATHER_ORIGIN : 0u)
           | (is_final_gather(vertex.path) ? FINAL_GATHER_HIT : 0u);
}

// All members but those of the lobe are written before it is selected: processors have no registers to keep the rest
// of an importon beside a lobe. u: uniform in [0, 1).
void leave_importon(SurfaceVertex vertex, LobeSelection lobes, float u) {
    uint index = vertex.index;
    Closure closure = vertex.closure;
    vec3 throughput = vertex.path.throughput;
    vec3 diffuse = throughput * closure.diffuse / PI, translucent = throughput * closure.translucent / PI;
    importons[index].position = closure.position;
    importons[index].direction = -vertex.ray.direction;
    importons[index].geometric_normal = closure.geometric_normal;
    importons[index].diffuse = diffuse;
    importons[index].diffuse_normal = closure.diffuse_normal;
    importons[index].translucent = translucent;
    importons[index].diffuse_roughness = closure.diffuse_roughness;
    importons[index].next = 0u;
    importons[index].gathers = gather_flags(vertex);
    importons[index].shading_normal = closure.shading_normal;
    importons[index].minimum_radius = vertex.radii.minimum;
    importons[index].history = history_word(vertex.history, vertex.history, vertex.path.depth);
    ClosureLobe lobe = sample_importon_lobe(vertex, lobes.stored, u);
    bool stores = unpack_kind(lobe.kind) != LOBE_NONE || !(largest(diffuse + translucent) <= 0.0);
    importons[index].radius = stores && !is_last_vertex(vertex.path) ? vertex.radii.maximum : 0.0;
    importons[index].lobe_weight = lobe.weight;
    importons[index].lobe_kind = lobe.kind;
    importons[index].lobe_f0 = lobe.f0;
    importons[index].lobe_alpha = lobe.alpha;
    importons[index].lobe_ior = lobe.ior;
    importons[index].lobe_normal = lobe.normal;
    importons[index].lobe_anisotropy = lobe.anisotropy;
}

// Neighboring pixels reuse the radiance that leaves the first surface at which the ray of a final gather finds photons.
void record_final_gather_hit(SurfaceVertex vertex, LobeSelection lobes) {
    if (!is_final_gather(vertex.path) || is_secondary_gather(vertex.path)) return;
    if ((vertex.path.flags & PATH_CAUSTIC) != 0u) return;
    if (!(sum(lobes.stored) > 0.0)) return;
    final_gather_hits[vertex.index].position = vertex.closure.position;
    final_gather_hits[vertex.index].normal = vertex.closure.geometric_normal;
}
