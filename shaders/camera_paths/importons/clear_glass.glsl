// SPDX-License-Identifier: GPL-3.0-or-later
// Transparent Glass: a transparent film shows the background behind what transmits light clearly, as in Cycles.
// The includer includes common/camera_path.glsl and common/bsdf/closure.glsl before.
#include "common/iteration.glsl"
#include <ClearGlass>

// Whether a path that escapes has reached the background of the film: it has passed nothing but transparent surfaces
// and, with Transparent Glass, clear ones.
bool sees_background(uint flags) {
#ifdef TRANSPARENT_GLASS
    if ((flags & (PATH_FINAL_GATHER | PATH_BEHIND_CLEAR_GLASS)) == PATH_BEHIND_CLEAR_GLASS) return true;
#endif
    return (flags & PATH_CAMERA_TRANSPARENT) != 0u;
}

#ifdef TRANSPARENT_GLASS
// The flags of a path that a lobe scatters; before: the path's own, as it came.
uint with_clear_glass(uint flags, uint before, MicrofacetLobe lobe, bool transmitted) {
    if ((before & PATH_FINAL_GATHER) != 0u) return flags;
    float roughness = iteration.film_transparent_roughness;
    bool is_clear =
        transmitted && lobe_has_facets(lobe.kind) && lobe.alpha <= max(roughness * roughness, MIN_MIS_ALPHA);
    return is_clear && sees_background(before) ? flags | PATH_BEHIND_CLEAR_GLASS : flags & ~PATH_BEHIND_CLEAR_GLASS;
}
#endif
