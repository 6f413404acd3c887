// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/nodes/voronoi_features.glsl"

void node_tex_voronoi(int voronoi_dimensions, int metric, int feature, int normalize_sum, vec3 vector, float w,
                      float scale, float detail, float roughness, float lacunarity, float smoothness, float exponent,
                      float randomness, out float distance_out, out vec3 color, out vec3 position, out float w_out,
                      out float radius) {
    int dimensions = voronoi_dimensions + 1;
    detail = clamp(detail, 0.0, 15.0);
    roughness = clamp(roughness, 0.0, 1.0);
    randomness = clamp(randomness, 0.0, 1.0);
    smoothness = clamp(0.5 * smoothness, 0.0, 0.5);
    vec4 p =
        dimensions == 1 ? vec4(w * scale, 0.0, 0.0, 0.0) : vec4(vector * scale, w * scale) * voronoi_axes(dimensions);
    bool edge = feature == VORONOI_DISTANCE_TO_EDGE;
    distance_out = edge ? 8.0 : 0.0;
    color = vec3(0.0);
    position = vec3(0.0);
    w_out = radius = 0.0;

    float furthest = 0.5 + 0.5 * randomness;
    if (!edge) {
        float rank = voronoi_rank(dimensions, metric, exponent, furthest * voronoi_axes(dimensions));
        furthest = voronoi_root(dimensions, metric, exponent, rank);
    }
    if (feature == VORONOI_F2) furthest *= 2.0;
    vec4 place = vec4(0.0);
    float amplitude = 1.0, octave_scale = 1.0, total = edge ? furthest : 0.0;
    int last = roughness == 0.0 || feature == VORONOI_N_SPHERE_RADIUS ? 0 : int(ceil(detail));
    for (int i = 0; i <= last; ++i) {
        float fraction = float(i) <= detail ? 1.0 : fract(detail);
        VoronoiOctave octave =
            voronoi_octave(dimensions, metric, feature, smoothness, exponent, randomness, p * octave_scale);
        if (edge) {
            float reached = min(distance_out, octave.distance / octave_scale);
            total = mix(total, mix(total, furthest / octave_scale, amplitude), fraction);
            distance_out = mix(distance_out, mix(distance_out, reached, amplitude), fraction);
        } else {
            total += fraction * amplitude;
            distance_out += fraction * amplitude * octave.distance;
            color += fraction * amplitude * octave.color;
            place = mix(place, mix(place, octave.position / octave_scale, amplitude), fraction);
        }
        octave_scale *= lacunarity;
        amplitude *= roughness;
    }
    if (feature == VORONOI_N_SPHERE_RADIUS) {
        radius = distance_out;
        distance_out = 0.0;
    } else {
        if (normalize_sum != 0) {
            distance_out /= edge ? total : total * furthest;
            color /= total;
        }
        place = scale != 0.0 ? place / scale : vec4(0.0);
        if (!edge && dimensions > 1) position = place.xyz;
        if (!edge && dimensions == 1) w_out = place.x;
        if (!edge && dimensions == 4) w_out = place.w;
    }
}
