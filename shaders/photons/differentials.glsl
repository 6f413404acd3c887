// SPDX-License-Identifier: GPL-3.0-or-later
// How far from a photon its neighbors come to lie: ray differentials (Igehy, SIGGRAPH 1999) from the light on, by
// smooth surfaces, as in photon differentials (Frisvad, Schjoth, Erleben, Sporring, Computer Graphics Forum 2014).
// Needs the member footprint_photons of the parameters.

#include "common/iteration.glsl"
#include <PhotonDifferential>
readonly buffer Triangles;
readonly buffer Attributes;
buffer PhotonDifferentials;

// What of the light's own extent a footprint covers at least, as a part of its radius.
const float BLUR_FRACTION = 0.5;

// From the ray's origin to the point where it hits a surface with a geometric normal. The light's points are taken to
// aim at the same first hit.
PhotonDifferential moved_to_hit(PhotonDifferential at, vec3 direction, float distance, vec3 geometric, bool first) {
    float traveled = first ? at.before + distance : distance, cosine = dot(direction, geometric);
    at.place_u += traveled * at.turn_u;
    at.place_v += traveled * at.turn_v;
    at.place_u -= direction * (dot(at.place_u, geometric) / cosine);
    at.place_v -= direction * (dot(at.place_v, geometric) / cosine);
    if (first) {
        at.spread += at.blur / max(traveled, 1e-20);
        at.blur = 0.0;
    } else at.blur += traveled * at.spread;
    return at;
}

// Of the disk that holds as many photons as a footprint is to hold, as bits of a photon's flags.
uint packed_footprint(PhotonDifferential at) {
    float blur = BLUR_FRACTION * at.blur;
    float radius2 = parameters.footprint_photons * length(cross(at.place_u, at.place_v)) / PI + blur * blur;
    return at.known != 0u ? footprint_bits(iteration.shrinkage * sqrt(radius2)) : 0u;
}

// By how much the shading normal changes with the place on a triangle whose normals are interpolated.
struct NormalChange {
    vec3 gradient1;
    vec3 gradient2;
    vec3 change1;
    vec3 change2;
    vec3 normal;
};

NormalChange normal_change(uint triangle, vec3 position, vec3 normal) {
    vec3 v0 = triangle_vertices[3u * triangle].xyz, e1 = triangle_vertices[3u * triangle + 1u].xyz - v0,
         e2 = triangle_vertices[3u * triangle + 2u].xyz - v0, face = cross(e1, e2);
    vec3 n0 = unpack_unit_vector(attributes[triangle].normal0);
    NormalChange change;
    change.gradient1 = cross(e2, face) / dot(face, face);
    change.gradient2 = cross(face, e1) / dot(face, face);
    change.change1 = unpack_unit_vector(attributes[triangle].normal1) - n0;
    change.change2 = unpack_unit_vector(attributes[triangle].normal2) - n0;
    vec3 offset = position - v0;
    vec3 sum = n0 + dot(offset, change.gradient1) * change.change1 + dot(offset, change.gradient2) * change.change2;
    float scale = (dot(sum, normal) < 0.0 ? -1.0 : 1.0) / max(length(sum), 1e-6);
    change.change1 *= scale;
    change.change2 *= scale;
    change.normal = normal;
    return change;
}

vec3 normal_turn(NormalChange change, vec3 place) {
    vec3 turn = dot(place, change.gradient1) * change.change1 + dot(place, change.gradient2) * change.change2;
    return turn - change.normal * dot(change.normal, turn);
}

// What becomes of a direction's differential where it is mirrored, or refracted with a ratio of indices.
vec3 mirrored_turn(vec3 turn, vec3 normal_turn, vec3 arriving, vec3 normal) {
    float cosine = dot(arriving, normal), change = dot(turn, normal) + dot(arriving, normal_turn);
    return turn - 2.0 * (cosine * normal_turn + change * normal);
}

vec3 refracted_turn(vec3 turn, vec3 normal_turn, vec3 arriving, vec3 leaving, vec3 normal, float ratio) {
    float cosine = dot(arriving, normal), cosine_leaving = dot(leaving, normal);
    float change = dot(turn, normal) + dot(arriving, normal_turn);
    float along = ratio * cosine - cosine_leaving;
    float along_change = (ratio - ratio * ratio * cosine / cosine_leaving) * change;
    return ratio * turn - (along * normal_turn + along_change * normal);
}
