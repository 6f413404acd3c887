// SPDX-License-Identifier: GPL-3.0-or-later
// What a Voronoi texture tells of a place: the nearest points and the borders around it.
#include "materials/nodes/voronoi_cells.glsl"

struct VoronoiOctave { float distance; vec3 color; vec4 position; };

// The nearest point, or the second nearest (a literal).
VoronoiOctave voronoi_nearest(
    int dimensions, int metric, bool second, float exponent, float randomness, vec4 coordinates
) {
    vec4 corner = floor(coordinates);
    ivec4 cell = ivec4(corner);
    vec4 place = coordinates - corner;
    float nearest = VORONOI_FAR, next = VORONOI_FAR;
    int middle = voronoi_cells(dimensions, 3) / 2;
    int nearest_index = middle, next_index = middle;
    for (int index = 0; index < voronoi_cells(dimensions, 3); ++index) {
        ivec4 offset = voronoi_offset(dimensions, 3, index);
        vec4 point = vec4(offset) + voronoi_point(dimensions, cell + offset) * randomness;
        float reached = voronoi_distance(dimensions, metric, exponent, point, place);
        if (reached < nearest) {
            next = nearest;
            next_index = nearest_index;
            nearest = reached;
            nearest_index = index;
        } else if (reached < next) {
            next = reached;
            next_index = index;
        }
    }
    ivec4 offset = voronoi_offset(dimensions, 3, second ? next_index : nearest_index);
    VoronoiOctave octave;
    octave.distance = second ? next : nearest;
    octave.color = voronoi_color(dimensions, cell + offset);
    octave.position = vec4(offset) + voronoi_point(dimensions, cell + offset) * randomness + corner;
    return octave;
}

// Blends the cells in turn with a polynomial smooth minimum; as Cycles, of the 3 cells' width where it is not smooth.
VoronoiOctave voronoi_smooth(
    int dimensions, int metric, float smoothness, float exponent, float randomness, vec4 coordinates
) {
    vec4 corner = floor(coordinates);
    ivec4 cell = ivec4(corner);
    vec4 place = coordinates - corner;
    VoronoiOctave octave = VoronoiOctave(0.0, vec3(0.0), vec4(0.0));
    bool smoothed = smoothness > 0.0, started = false;
    for (int index = 0; index < voronoi_cells(dimensions, 5); ++index) {
        ivec4 offset = voronoi_offset(dimensions, 5, index);
        vec4 point = vec4(offset) + voronoi_point(dimensions, cell + offset) * randomness;
        float reached = voronoi_distance(dimensions, metric, exponent, point, place);
        if (smoothed || all(lessThan(abs(offset), ivec4(2)))) {
            float lead = octave.distance - reached;
            float share = smoothed ? smoothstep(0.0, 1.0, 0.5 + 0.5 * lead / smoothness) : lead > 0.0 ? 1.0 : 0.0;
            if (!started) share = 1.0;
            started = true;
            float correction = smoothness * share * (1.0 - share);
            octave.distance = mix(octave.distance, reached, share) - correction;
            correction /= 1.0 + 3.0 * smoothness;
            octave.color = mix(octave.color, voronoi_color(dimensions, cell + offset), share) - correction;
            octave.position = mix(octave.position, point, share) - correction * voronoi_axes(dimensions);
        }
    }
    octave.position += corner;
    return octave;
}

// Place in the neighbourhood, 3 cells wide, of the point nearest by Euclidean distance.
int voronoi_nearest_cell(int dimensions, float randomness, ivec4 cell, vec4 place) {
    float nearest = VORONOI_FAR;
    int found = voronoi_cells(dimensions, 3) / 2;
    for (int index = 0; index < voronoi_cells(dimensions, 3); ++index) {
        ivec4 offset = voronoi_offset(dimensions, 3, index);
        vec4 way = vec4(offset) + voronoi_point(dimensions, cell + offset) * randomness - place;
        float reached = dot(way, way);
        if (reached < nearest) {
            nearest = reached;
            found = index;
        }
    }
    return found;
}

// To the nearest plane halfway between the nearest point and another.
float voronoi_edge_distance(int dimensions, float randomness, vec4 coordinates) {
    vec4 corner = floor(coordinates);
    ivec4 cell = ivec4(corner);
    vec4 place = coordinates - corner;
    if (dimensions == 1) {
        // Cycles looks at the two borders of the cell's own point, whose key may be -0.0 here.
        float own = hash_to_unit(corner.x) * randomness;
        float left = voronoi_point(1, cell - 1).x * randomness - 1.0;
        float right = voronoi_point(1, cell + 1).x * randomness + 1.0;
        return min(abs(0.5 * (own + left) - place.x), abs(0.5 * (own + right) - place.x));
    }
    ivec4 own = voronoi_offset(dimensions, 3, voronoi_nearest_cell(dimensions, randomness, cell, place));
    vec4 nearest = vec4(own) + voronoi_point(dimensions, cell + own) * randomness - place;
    float edge = VORONOI_FAR;
    for (int index = 0; index < voronoi_cells(dimensions, 3); ++index) {
        ivec4 offset = voronoi_offset(dimensions, 3, index);
        vec4 way = vec4(offset) + voronoi_point(dimensions, cell + offset) * randomness - place;
        vec4 across = way - nearest;
        float squared = dot(across, across);
        if (squared > 0.0001) edge = min(edge, 0.5 * dot(nearest + way, across * inversesqrt(squared)));
    }
    return edge;
}

// Half the way from the nearest point to the point nearest to that.
float voronoi_sphere_radius(int dimensions, float randomness, vec4 coordinates) {
    vec4 corner = floor(coordinates);
    ivec4 cell = ivec4(corner);
    ivec4 own = voronoi_offset(
        dimensions, 3, voronoi_nearest_cell(dimensions, randomness, cell, coordinates - corner)
    );
    vec4 centre = voronoi_point(dimensions, cell + own) * randomness;
    float nearest = VORONOI_FAR;
    for (int index = 0; index < voronoi_cells(dimensions, 3); ++index) {
        ivec4 offset = voronoi_offset(dimensions, 3, index);
        vec4 way = vec4(offset) + voronoi_point(dimensions, cell + own + offset) * randomness - centre;
        if (offset != ivec4(0)) nearest = min(nearest, length(way));
    }
    return 0.5 * nearest;
}
