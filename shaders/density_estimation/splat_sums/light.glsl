// SPDX-License-Identifier: GPL-3.0-or-later
// The sums of photons again, split as the passes of light are. Included behind add.glsl or collect.glsl.

#include "common/path_history.glsl"
#include "density_estimation/splat_sums/add_light.glsl"

// What a photon's light adds to which sum: the first two by what scatters it toward the camera path, a diffuse part and
// a lobe; the third to that of caustics.
struct LightPart {
    uint sum;
    vec3 radiance;
};

LightPart light_part(uint part, Importon importon, uint photon, uint photon_flags, Estimate estimate) {
    uint history = arrived_history(importon.history), first = first_scatter(history);
    uint scatter = lobe_scatter(unpack_kind(importon.lobe_kind), !estimate.front);
    bool diffuse_lobe = scatter == SCATTER_DIFFUSE, final_gather = (importon.gathers & FINAL_GATHER_HIT) != 0u;
    vec3 diffuse = diffuse_lobe ? estimate.radiance : estimate.diffuse;
    vec3 lobe = estimate.radiance - diffuse;
    if (part == 2u) {
        bool is_caustic = ((history & HISTORY_CAUSTIC) != 0u) || (photon_flags & PHOTON_CAUSTIC) != 0u;
        vec3 caustic = vec3(0.0);
        if (is_caustic || (photon_flags & PHOTON_SCATTERED_BY_LOBE) != 0u) caustic += diffuse;
        if (is_caustic || (history & HISTORY_DIFFUSE) != 0u) caustic += lobe;
        return LightPart(final_gather ? FINAL_GATHER_CAUSTICS : CAUSTICS_SUM, caustic);
    }
    bool indirect = is_indirect(photon_flags, photons[photon].bounce_counts, photons[photon].depth),
         of_diffuse = part == 0u;
    if (final_gather) return LightPart(0u, vec3(0.0));
    if (first != SCATTER_NONE) return LightPart(scattered_sum(first, true), of_diffuse ? estimate.radiance : vec3(0.0));
    if (of_diffuse) return LightPart(scattered_sum(SCATTER_DIFFUSE, indirect), diffuse);
    return LightPart(scattered_sum(scatter, indirect), diffuse_lobe ? vec3(0.0) : lobe);
}

// In a loop of which drivers do not know the rounds: they would have the code of each sum apart.
void add_light(uint pixel, Importon importon, uint photon, uint photon_flags, Estimate estimate) {
    if ((parameters.light_sums & LIGHT_SUMS_GROUPS) != 0u)
        add_to_group_sum(pixel, photon_origins[photon_path_of(photons[photon].path)].light_group,
                         (importon.gathers & FINAL_GATHER_HIT) != 0u, estimate.radiance);
    uint first = (parameters.light_sums & LIGHT_SUMS_SCATTERED) != 0u ? 0u : 2u;
    uint end = (parameters.light_sums & LIGHT_SUMS_CAUSTICS) != 0u ? 3u : 2u;
    for (uint number = first; number < end; ++number) {
        LightPart part = light_part(number, importon, photon, photon_flags, estimate);
        add_to_light_sum(pixel, part.sum, part.radiance);
    }
}
