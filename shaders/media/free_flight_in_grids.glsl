// SPDX-License-Identifier: GPL-3.0-or-later
// Free flights along rays on which the media vary. free_flight.glsl includes this file, and has the same functions for
// media that are the same everywhere.

#ifdef HETEROGENEOUS_MEDIA
// u: chooses the channel, and the distance.
FreeFlight sample_free_flight(uint flags, Ray ray, float far, vec2 u) {
    FreeFlight flight;
    vec3 passed;
    flight.distance = segment_free_flight(flags, ray.origin, ray.direction, far, min(int(3.0 * u.x), 2), u.y, passed);
    flight.transmittance = exp(-passed);
    flight.pdf = 0.0;
    if (flight.distance < far) {
        MediumCoefficients medium = path_medium(flags, PlaceOnRay(ray.origin, ray.direction, flight.distance));
        flight.pdf = dot((medium.absorption + medium.scattering) * flight.transmittance, vec3(1.0 / 3.0));
    }
    return flight;
}

// Pdfs of the channels' distances in one of the media of a path times the medium's optical thickness, which is the
// probability of the medium up to the sum. before: its thickness up to the distance.
vec3 scattered_densities(vec3 extinction, vec3 thickness, vec3 before) {
    vec3 normalized = mix(thickness / max(1.0 - exp(-thickness), vec3(1e-30)), 1.0 + 0.5 * thickness,
                          lessThanEqual(thickness, vec3(1e-3)));
    return extinction * exp(-before) * normalized;
}

// Mean of densities over the channels in which the media have any thickness.
float mean_density(vec3 densities, vec3 thickness) {
    vec3 counts = vec3(greaterThan(thickness, vec3(0.0)));
    return dot(counts * densities / max(thickness, vec3(1e-30)), vec3(1.0)) / max(dot(counts, vec3(1.0)), 1.0);
}

// Whether a path is in no medium but one with a grid.
bool has_one_grid(uint flags) {
    uint medium, set = flags >> FIRST_MEDIUM;
    bool world = true, any = next_grid(set, world, medium);
    return any && !next_grid(set, world, medium) && even_extinction(flags) == vec3(0.0);
}

// Pdf of sample_scattered_flight, 1/m. thickness: of all media along the ray; transmittance: up to the distance.
float scattered_flight_pdf(uint flags, Ray ray, float far, float distance, vec3 thickness, out vec3 transmittance) {
    vec3 even = even_extinction(flags), offset = lookup_offset(ray.origin, ray.direction);
    vec3 densities = scattered_densities(even, even * far, even * distance), passed = even * distance;
    bool world = true, is_alone = has_one_grid(flags);
    uint medium;
    for (uint set = flags >> FIRST_MEDIUM; next_grid(set, world, medium);) {
        vec3 before = grid_thickness(medium, ray.origin, ray.direction, distance, offset), of_grid = thickness;
        if (!is_alone) of_grid = grid_thickness(medium, ray.origin, ray.direction, far, offset);
        MediumCoefficients grid = grid_coefficients(medium, PlaceOnRay(ray.origin, ray.direction, distance));
        densities += scattered_densities(grid.absorption + grid.scattering, of_grid, before);
        passed += before;
    }
    transmittance = exp(-passed);
    return mean_density(densities, thickness);
}

// Optical thickness, after which a path collides, for a random number: it does before the thickness of the segment.
float scattered_thickness(float thickness, float u) {
    return thickness > 1e-3 ? -log(max(1.0 - u * (1.0 - exp(-thickness)), 1e-30)) : u * thickness;
}

// The distance at which a channel's light is scattered, in one of the media that is chosen by its thickness.
float scattered_distance(uint flags, Ray ray, float far, int channel, float thickness, vec2 u) {
    float even = even_extinction(flags)[channel], rest = u.x * thickness;
    if (rest < even * far) return min(scattered_thickness(even * far, u.y) / even, far);
    rest -= even * far;
    vec3 offset = lookup_offset(ray.origin, ray.direction), passed;
    bool world = true, is_alone = has_one_grid(flags);
    uint medium;
    float distance = 0.0;
    for (uint set = flags >> FIRST_MEDIUM; next_grid(set, world, medium);) {
        float part = thickness;
        if (!is_alone) part = grid_thickness(medium, ray.origin, ray.direction, far, offset)[channel];
        if (!(part > 0.0)) continue;
        float aim = min(scattered_thickness(part, u.y), 0.999999 * part);
        distance = grid_free_flight(medium, ray.origin, ray.direction, far, offset, channel, aim, passed);
        if (rest < part) break;
        rest -= part;
    }
    return min(distance, far);
}

// A distance at which light is scattered before the end of the ray. Its pdf is scattered_flight_pdf.
float sample_scattered_flight(uint flags, Ray ray, float far, vec3 thickness, vec2 u) {
    ivec3 counts = ivec3(greaterThan(thickness, vec3(0.0)));
    int count = counts.x + counts.y + counts.z;
    if (count == 0) return 0.0;
    float scaled = u.x * float(count);
    int number = min(int(scaled), count - 1), channel = 0;
    for (int k = 0; k < 3; ++k) {
        if (counts[k] == 0) continue;
        channel = k;
        if (number == 0) break;
        --number;
    }
    return scattered_distance(flags, ray, far, channel, thickness[channel], vec2(fract(scaled), u.y));
}
#endif
