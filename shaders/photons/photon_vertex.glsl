// SPDX-License-Identifier: GPL-3.0-or-later
// The vertices of photon paths, and the photons that are stored there. The includer declares the blocks that hold these
// before.

#include "common/transparency.glsl"
#include "photons/differentials.glsl"
#include "photons/path_flags.glsl"

// The vertex of a photon path on a surface.
struct PhotonVertex {
    uint index;  // of the path
    uint flags;  // of the path as it arrives
    uint depth;  // of the path as it arrives
    uint bounce_counts;
    vec3 flux;  // that arrives, W
    vec3 wo;    // toward the origin of the ray
    Closure closure;
    float remaining_distance;  // of the ray behind the surface
    bool has_differential;     // whether the footprint of the photon is known
};

PhotonVertex photon_vertex(uint index, PhotonPath path, Ray ray) {
    Closure closure = closures[index];
    vec3 flux = path.flux * segment_transmittance(path.flags, ray.origin, ray.direction, closure.distance);
    return PhotonVertex(index, path.flags, path.depth, path.bounce_counts, flux, -ray.direction, closure,
                        ray.maximum_distance - closure.distance, photon_differentials[index].known != 0u);
}

float channel_sum(vec3 flux) { return flux.x + flux.y + flux.z; }

bool has_flux(vec3 flux) { return largest(flux) > 0.0; }

// Each active path of a segment has a place in the list of photons.
void write_photon(uint index, Photon photon) {
    photon.path = index | parameters.segment << PHOTON_SEGMENT_SHIFT;
    photons[photon_first + active_place()] = photon;
}

// The photon of a path that carries no flux any more.
void write_ended_path(uint index, PhotonPath path, Ray ray) {
    write_photon(index,
                 Photon(vec3(0.0), 0u, path.flux, 0u, -ray.direction, 0.0, 0u, path.depth, path.bounce_counts, 0u));
}

void handle_escaped(uint index, PhotonPath path, Ray ray) {
    uint flags = PHOTON_ACTIVE | photon_flags(path.flags) | PHOTON_ESCAPED;
    write_photon(index, Photon(vec3(0.0), flags, path.flux, 0u, -ray.direction, INFINITY_DISTANCE, 0u, path.depth,
                               path.bounce_counts, 0u));
    photon_paths[index].escaped = channel_sum(path.flux);
}

bool stores_photons(PhotonVertex vertex) {
    bool stores = largest(vertex.closure.diffuse + vertex.closure.translucent) > 0.0;
    for (int k = 0; k < closure_lobes(vertex.closure); ++k)
        stores = stores || lobe_stores(stored_lobe(vertex.index, k), iteration.specular_alpha);
    return stores && (vertex.flags & PHOTON_NOT_DIFFUSE) == 0u;
}

// The photon is written before the path is scattered, because that needs more registers. Its footprint follows from the
// ray differential, which is carried on to the vertex.
void store_photon(PhotonVertex vertex) {
    Closure closure = vertex.closure;
    uint flags = PHOTON_ACTIVE | photon_flags(vertex.flags);
    PhotonDifferential differential = photon_differentials[vertex.index];
    if (vertex.has_differential) {
        differential = moved_to_hit(differential, -vertex.wo, closure.distance,
                                    unpack_unit_vector(closure.geometric_normal), parameters.segment == 0u);
        flags |= packed_footprint(differential);
        if (has_flux(vertex.flux)) photon_differentials[vertex.index] = differential;
    }
    if (stores_photons(vertex)) flags |= PHOTON_STORED;
    float distance = differential.before + closure.distance;
    write_photon(vertex.index, Photon(closure.position, flags, vertex.flux, closure.geometric_normal, vertex.wo,
                                      distance, 0u, vertex.depth, vertex.bounce_counts, 0u));
    photon_differentials[vertex.index].before = distance;
}
