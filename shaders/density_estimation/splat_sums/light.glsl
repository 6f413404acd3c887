// SPDX-License-Identifier: GPL-3.0-or-later
// The sums of photons again, split as the passes of light are. Included behind add.glsl or collect.glsl.

#include "common/path_history.glsl"
#include "density_estimation/splat_sums/light_sums.glsl"
#include "film/light_groups/group_sums.glsl"
buffer LightSums;
readonly buffer PhotonGroups;
buffer GroupSums;

void add_light_word(uint place, float quanta) {
    uvec2 added = whole_quanta(quanta);
    if (added.x > 0u && atomicAdd(light_words[place], added.x) > 0xffffffffu - added.x) added.y += 1u;
    if (added.y > 0u) atomicAdd(light_words[place + 1u], added.y);
}

void add_to_light_sum(uint pixel, uint sum, vec3 radiance) {
    if (!(largest(radiance) > 0.0)) return;
    uint place = first_light_word(pixel, sum, parameters.light_sums);
    add_light_word(place, radiance.r * parameters.quanta);
    add_light_word(place + 2u, radiance.g * parameters.quanta);
    add_light_word(place + 4u, radiance.b * parameters.quanta);
}

void add_group_word(uint place, float quanta) {
    uvec2 added = whole_quanta(quanta);
    if (added.x > 0u && atomicAdd(group_words[place], added.x) > 0xffffffffu - added.x) added.y += 1u;
    if (added.y > 0u) atomicAdd(group_words[place + 1u], added.y);
}

void add_to_group_sum(uint pixel, uint group, bool final_gather, vec3 radiance) {
    if (group == NO_LIGHT_GROUP) return;
    uint place = first_group_word(pixel, group, final_gather, parameters.light_groups);
    for (uint channel = 0u; channel < 3u; ++channel)
        add_group_word(place + 2u * channel, radiance[channel] * parameters.quanta);
}

// What a photon's light adds to which sum: the first two by what scatters it toward the camera path, a diffuse part and
// a lobe; the third to that of caustics.
struct LightPart {
    uint sum;
    vec3 radiance;
};

LightPart light_part(uint part, Importon importon, uint photon_flags, Estimate estimate) {
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
    bool indirect = (photon_flags & (PHOTON_SCATTERED_BY_LOBE | PHOTON_INDIRECT)) != 0u, of_diffuse = part == 0u;
    if (final_gather) return LightPart(0u, vec3(0.0));
    if (first != SCATTER_NONE) return LightPart(scattered_sum(first, true), of_diffuse ? estimate.radiance : vec3(0.0));
    if (of_diffuse) return LightPart(scattered_sum(SCATTER_DIFFUSE, indirect), diffuse);
    return LightPart(scattered_sum(scatter, indirect), diffuse_lobe ? vec3(0.0) : lobe);
}

// In a loop of which drivers do not know the rounds: they would have the code of each sum apart.
void add_light(uint pixel, Importon importon, uint photon, uint photon_flags, Estimate estimate) {
    if ((parameters.light_sums & LIGHT_SUMS_GROUPS) != 0u)
        add_to_group_sum(pixel, photon_groups[photon_path_of(photons[photon].path)],
                         (importon.gathers & FINAL_GATHER_HIT) != 0u, estimate.radiance);
    uint first = (parameters.light_sums & LIGHT_SUMS_SCATTERED) != 0u ? 0u : 2u;
    uint end = (parameters.light_sums & LIGHT_SUMS_CAUSTICS) != 0u ? 3u : 2u;
    for (uint number = first; number < end; ++number) {
        LightPart part = light_part(number, importon, photon_flags, estimate);
        add_to_light_sum(pixel, part.sum, part.radiance);
    }
}
