// SPDX-License-Identifier: GPL-3.0-or-later

// How far the geometric normals of photon and importon may part, as a cosine, and how far a photon may lie off the
// importon's tangent plane in radii: beyond, they are on different surfaces. Around a bend photons count, since their
// flux is weighted by the importon's own BSDF; around an edge they do not.
const float PHOTON_NORMAL_TOLERANCE = 0.7;
const float PHOTON_PLANE_TOLERANCE = 0.35;

// What heights over a plane may be off by: parts of the way, by normals of two 16-bit words, and of the height.
const float NORMAL_ROUNDING = 1e-4;
const float HEIGHT_ROUNDING = 0.01;

// Whether a photon's light cannot come to the importon, as it lies behind another surface that shuts it off: the
// photon behind the importon's plane, the importon before the photon's, so that they are on no bend of one surface,
// and what sent the photon behind the importon's plane as well. height, photon_height: of the photon over the
// importon's plane, on the side from which the light would have to come, and over the plane that the importon would lie
// in if it faced as the photon does; rise: of what sent the photon, that far away, over the photon.
bool is_shut_off(float height, float photon_height, float rise, float away, float radius) {
    float slack = NORMAL_ROUNDING * radius;
    return max(height, photon_height) < slack
           && height + rise < HEIGHT_ROUNDING * abs(height) + NORMAL_ROUNDING * away + slack;
}
