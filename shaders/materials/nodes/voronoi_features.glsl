// SPDX-License-Identifier: GPL-3.0-or-later
// What one octave of a Voronoi texture gives at a place: the nearest points and the borders around it.
#include "materials/nodes/voronoi_cells.glsl"

#include <VoronoiFeatures>

// The distance is that to the edge or the radius where that is the feature, without color and position then.
struct VoronoiOctave {
    float distance;
    vec3 color;
    vec4 position;
};

// Blends a cell in with a polynomial smooth minimum; the first one replaces what is there.
void voronoi_blend(inout VoronoiOctave octave, bool first, float smoothness, float reached, vec3 color, vec4 point,
                   vec4 axes) {
    float lead = octave.distance - reached;
    float blend = smoothness > 0.0 ? smoothstep(0.0, 1.0, 0.5 + 0.5 * lead / smoothness) : lead > 0.0 ? 1.0 : 0.0;
    if (first) blend = 1.0;
    float correction = smoothness * blend * (1.0 - blend);
    octave.distance = mix(octave.distance, reached, blend) - correction;
    correction /= 1.0 + 3.0 * smoothness;
    octave.color = mix(octave.color, color, blend) - correction;
    octave.position = mix(octave.position, point, blend) - correction * axes;
}

// From a place in a cell to the nearest plane halfway between the nearest point and another one; or half the way
// from the nearest point to the one nearest to that.
float voronoi_border(int dimensions, bool to_edge, float randomness, vec4 corner, vec4 place, ivec4 chosen,
                     vec4 center) {
    ivec4 cell = ivec4(corner);
    if (to_edge && dimensions == 1) {
        // Cycles looks at the two borders of the cell's own point, whose key may be -0.0.
        chosen = ivec4(0);
        center.x = hash_to_unit(corner.x) * randomness;
    }
    float border = VORONOI_FAR;
    for (int index = 0; index < voronoi_cells(dimensions, 3); ++index) {
        ivec4 offset = voronoi_offset(dimensions, 3, index);
        if (!to_edge) offset += chosen;
        vec4 point = vec4(offset) + voronoi_point(dimensions, cell + offset) * randomness;
        vec4 across = point - center;
        float squared = dot(across, across);
        bool other = to_edge && dimensions > 1 ? squared > 0.0001 : offset != chosen;
        float reached = 0.5 * sqrt(squared);
        if (to_edge) reached = dot(0.5 * (point + center) - place, across * inversesqrt(squared));
        if (dimensions == 1) reached = abs(reached);
        if (other) border = min(border, reached);
    }
    return border;
}

// Dimensions, metric and feature are literals. One pass over the cells serves all features, so that little code
// is left to compile.
VoronoiOctave voronoi_octave(int dimensions, int metric, int feature, float smoothness, float exponent,
                             float randomness, vec4 coordinates) {
    bool to_edge = feature == VORONOI_DISTANCE_TO_EDGE, to_neighbor = feature == VORONOI_N_SPHERE_RADIUS;
    if (to_edge || to_neighbor) metric = VORONOI_EUCLIDEAN;
    bool smoothed = feature == VORONOI_SMOOTH_F1;
    // As in Cycles; it shows where distances are too large for a float.
    bool by_distance = smoothed || feature == VORONOI_F2;
    int width = smoothed ? 5 : 3;
    vec4 corner = floor(coordinates);
    ivec4 cell = ivec4(corner);
    vec4 place = coordinates - corner;
    VoronoiOctave octave = VoronoiOctave(0.0, vec3(0.0), vec4(0.0));

    float nearest = VORONOI_FAR, next = VORONOI_FAR;
    int nearest_index = voronoi_cells(dimensions, 3) / 2, next_index = nearest_index;
    bool first = true;
    for (int index = 0; index < voronoi_cells(dimensions, width); ++index) {
        ivec4 offset = voronoi_offset(dimensions, width, index);
        vec4 point = vec4(offset) + voronoi_point(dimensions, cell + offset) * randomness;
        float reached = voronoi_rank(dimensions, metric, exponent, point - place);
        if (by_distance) reached = voronoi_root(dimensions, metric, exponent, reached);
        if (smoothed) {
            // Without smoothness Cycles looks at the 3 cells' width that F1 does.
            if (smoothness > 0.0 || all(lessThan(abs(offset), ivec4(2)))) {
                vec3 color = voronoi_color(dimensions, cell + offset);
                voronoi_blend(octave, first, smoothness, reached, color, point, voronoi_axes(dimensions));
                first = false;
            }
        } else if (reached < nearest) {
            next = nearest;
            next_index = nearest_index;
            nearest = reached;
            nearest_index = index;
        } else if (reached < next) {
            next = reached;
            next_index = index;
        }
    }

    if (smoothed) {
        octave.position += corner;
    } else {
        ivec4 chosen = voronoi_offset(dimensions, 3, feature == VORONOI_F2 ? next_index : nearest_index);
        vec4 center = vec4(chosen) + voronoi_point(dimensions, cell + chosen) * randomness;
        if (to_edge || to_neighbor) {
            octave.distance = voronoi_border(dimensions, to_edge, randomness, corner, place, chosen, center);
        } else {
            octave.distance = by_distance ? next : voronoi_root(dimensions, metric, exponent, nearest);
            octave.color = voronoi_color(dimensions, cell + chosen);
            octave.position = center + corner;
        }
    }
    return octave;
}
