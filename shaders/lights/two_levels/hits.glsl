// SPDX-License-Identifier: GPL-3.0-or-later
// Emissive triangles of instances get the numbers of hit triangles (acceleration/instances.glsl), to be gathered.
writeonly buffer HitOrigins;

uint keep_emitter(EmitterNumber triangle, uint place) {
    if (!is_of_instance(triangle)) return triangle.y;
    hit_origins[place] = triangle;
    return emitter_levels().first_hit_triangle + place;
}

// The triangle that a path's shadow ray goes to.
uint keep_sampled_emitter(EmitterNumber triangle, uint path) {
    return keep_emitter(triangle, emitter_levels().first_light_hit + path);
}

// The triangle that a path's photon has left.
uint keep_left_emitter(EmitterNumber triangle, uint path) {
    return keep_emitter(triangle, emitter_levels().first_photon_hit + 2u * path);
}
