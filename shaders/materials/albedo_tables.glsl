// SPDX-License-Identifier: GPL-3.0-or-later
// rppm_addon/materials/albedo_tables.py, in the order in which load() lists them.

layout(std430, binding = 9) readonly buffer AlbedoTables { float albedo_tables[]; };

const int WHITE_SIZE = 32;
const int TABLE_SIZE = 16;
const int WHITE_AVERAGE = WHITE_SIZE * WHITE_SIZE;
const int DIELECTRIC_TABLE = WHITE_AVERAGE + WHITE_SIZE;
const int GLASS_ENTERING_TABLE = DIELECTRIC_TABLE + TABLE_SIZE * TABLE_SIZE * TABLE_SIZE;
const int GLASS_LEAVING_TABLE = GLASS_ENTERING_TABLE + TABLE_SIZE * TABLE_SIZE * TABLE_SIZE;

float table_plane(int first, int size, float roughness, float cosine) {
    vec2 p = clamp(vec2(cosine, roughness), 0.0, 1.0) * float(size - 1);
    ivec2 i = min(ivec2(p), ivec2(size - 2));
    vec2 f = p - vec2(i);
    int at = first + i.y * size + i.x;
    return mix(mix(albedo_tables[at], albedo_tables[at + 1], f.x),
               mix(albedo_tables[at + size], albedo_tables[at + size + 1], f.x), f.y);
}

float table_volume(int first, float ior, float roughness, float cosine) {
    float z = sqrt(abs((ior - 1.0) / (ior + 1.0))) * float(TABLE_SIZE - 1);
    int i = clamp(int(z), 0, TABLE_SIZE - 2);
    int plane = TABLE_SIZE * TABLE_SIZE;
    return mix(table_plane(first + i * plane, TABLE_SIZE, roughness, cosine),
               table_plane(first + (i + 1) * plane, TABLE_SIZE, roughness, cosine), clamp(z - float(i), 0.0, 1.0));
}

float white_albedo(float roughness, float cosine) { return table_plane(0, WHITE_SIZE, roughness, cosine); }

float white_average_albedo(float roughness) {
    float p = clamp(roughness, 0.0, 1.0) * float(WHITE_SIZE - 1);
    int i = min(int(p), WHITE_SIZE - 2);
    return mix(albedo_tables[WHITE_AVERAGE + i], albedo_tables[WHITE_AVERAGE + i + 1], p - float(i));
}

float glass_albedo(float ior, float roughness, float cosine) {
    return ior >= 1.0 ? table_volume(GLASS_ENTERING_TABLE, ior, roughness, cosine)
                      : table_volume(GLASS_LEAVING_TABLE, 1.0 / ior, roughness, cosine);
}

// Albedo of a lobe whose reflectance is dielectric_interpolation: what grazing incidence adds.
float dielectric_grazing_albedo(float ior, float roughness, float cosine) {
    return table_volume(DIELECTRIC_TABLE, ior, roughness, cosine);
}
