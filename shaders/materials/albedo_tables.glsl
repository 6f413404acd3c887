// SPDX-License-Identifier: GPL-3.0-or-later
// Directional albedos of lobes (rppm_addon/materials/albedo_tables.py).
#include "common/whole_numbers.glsl"
#include <AlbedoTables>

readonly buffer AlbedoTables { float albedo_tables[]; };

float table_plane(int first, int size, float roughness, float cosine) {
    vec2 p = clamp(vec2(cosine, roughness), 0.0, 1.0) * float(size - 1);
    ivec2 i = min(whole_part(p), ivec2(size - 2));
    vec2 f = p - vec2(i);
    int at = first + i.y * size + i.x;
    return mix(mix(albedo_tables[at], albedo_tables[at + 1], f.x),
               mix(albedo_tables[at + size], albedo_tables[at + size + 1], f.x), f.y);
}

float ior_place(float ior) { return sqrt(abs((ior - 1.0) / (ior + 1.0))); }

float table_volume(int first, float ior, float roughness, float cosine) {
    float z = ior_place(ior) * float(TABLE_SIZE - 1);
    int i = whole_part(clamp(z, 0.0, float(TABLE_SIZE - 2)));
    int plane = TABLE_SIZE * TABLE_SIZE;
    return mix(table_plane(first + i * plane, TABLE_SIZE, roughness, cosine),
               table_plane(first + (i + 1) * plane, TABLE_SIZE, roughness, cosine), clamp(z - float(i), 0.0, 1.0));
}

float white_albedo(float roughness, float cosine) { return table_plane(WHITE_TABLE, WHITE_SIZE, roughness, cosine); }

float white_average_albedo(float roughness) {
    float p = clamp(roughness, 0.0, 1.0) * float(WHITE_SIZE - 1);
    int i = min(whole_part(p), WHITE_SIZE - 2);
    return mix(albedo_tables[WHITE_AVERAGE_TABLE + i], albedo_tables[WHITE_AVERAGE_TABLE + i + 1], p - float(i));
}

float glass_albedo(float ior, float roughness, float cosine) {
    bool enters = ior >= 1.0;
    return table_volume(enters ? GLASS_ENTERING_TABLE : GLASS_LEAVING_TABLE, enters ? ior : 1.0 / ior, roughness,
                        cosine);
}

float glass_average_albedo(float ior, float roughness) {
    bool enters = ior >= 1.0;
    return table_plane(enters ? GLASS_ENTERING_AVERAGE_TABLE : GLASS_LEAVING_AVERAGE_TABLE, TABLE_SIZE,
                       ior_place(enters ? ior : 1.0 / ior), roughness);
}

// The interpolation between the reflectances at normal and at grazing incidence, for all facets that the viewer sees.
float dielectric_interpolation_of_facets(float ior, float roughness, float cosine) {
    return table_volume(DIELECTRIC_TABLE, ior, roughness, cosine);
}

// Of the sheen: the coefficients of its transformation, and its albedo.
vec3 sheen_parameters(float roughness, float cosine) {
    return vec3(table_plane(SHEEN_A_TABLE, WHITE_SIZE, roughness, cosine),
                table_plane(SHEEN_B_TABLE, WHITE_SIZE, roughness, cosine),
                table_plane(SHEEN_TABLE, WHITE_SIZE, roughness, cosine));
}
