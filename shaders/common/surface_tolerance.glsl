// SPDX-License-Identifier: GPL-3.0-or-later

// How far the geometric normals of photon and importon may part, as a cosine, and how far a photon may lie off the
// importon's tangent plane in radii: beyond, they are on different surfaces. Around a bend photons count, since their
// flux is weighted by the importon's own BSDF; around an edge they do not.
const float PHOTON_NORMAL_TOLERANCE = 0.7;
const float PHOTON_PLANE_TOLERANCE = 0.35;
