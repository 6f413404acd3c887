// SPDX-License-Identifier: GPL-3.0-or-later
// Photometric profiles of luminaires; `table` is where one starts in material_data (rppm_addon/materials/ies.py).
#include "materials/data.glsl"

// Number of the last interval of ascending angles that starts before one.
uint ies_interval(uint first, uint count, float angle) {
    uint low = 0u, high = count - 2u;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (material_data[first + middle + 1u] < angle) low = middle + 1u;
        else high = middle;
    }
    return low;
}

// Weights of four neighbors for a place between the middle two (Catmull and Rom).
vec4 ies_weights(float x) {
    return 0.5
           * vec4(((2.0 - x) * x - 1.0) * x, (3.0 * x - 5.0) * x * x + 2.0, ((4.0 - 3.0 * x) * x + 1.0) * x,
                  (x - 1.0) * x * x);
}

void node_tex_ies(uint table, vec3 vector, float strength, out float fac) {
    fac = 0.0;
    vec3 direction = normalize(vector);
    float down = acos(clamp(-direction.z, -1.0, 1.0)), around = atan(direction.x, direction.y) + PI;
    uint rows = uint(material_data[table]), columns = uint(material_data[table + 1u]);
    uint h = table + 2u, v = h + rows, values = v + columns;
    bool inside = rows > 1u && columns > 1u && around >= material_data[h] && around < material_data[v - 1u]
                  && down >= material_data[v] && down < material_data[values - 1u];
    if (!inside) return;
    uint row = ies_interval(h, rows, around), column = ies_interval(v, columns, down);
    vec2 low = vec2(material_data[h + row], material_data[v + column]);
    vec2 high = vec2(material_data[h + row + 1u], material_data[v + column + 1u]);
    vec2 within = (vec2(around, down) - low) / (high - low);
    vec4 across = ies_weights(within.x), along = ies_weights(within.y);
    float value = 0.0;
    for (uint k = 0u; k < 4u; ++k) {
        uint at = values + (row + k) * (columns + 2u) + column;
        vec4 found = vec4(material_data[at], material_data[at + 1u], material_data[at + 2u], material_data[at + 3u]);
        value += across[k] * dot(along, found);
    }
    fac = strength * max(value, 0.0);
}
