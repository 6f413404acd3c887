// SPDX-License-Identifier: GPL-3.0-or-later
// Distances at which the media along a ray scatter light. The includer includes materials/medium.glsl before.

#include <Ray>
// A point where light is scattered, sampled by the extinction of one channel, which is chosen evenly.
struct FreeFlight {
    float distance;      // meters
    float pdf;           // of the distance, 1/m; 0 where the ray passes the media
    vec3 transmittance;  // up to there, or up to the end of the ray, whose mean is the probability of passing
};

// The densities of the three channels' distances, averaged (one-sample MIS with the balance heuristic).
float flight_pdf(vec3 extinction, float distance) {
    return dot(extinction * exp(-extinction * distance), vec3(1.0 / 3.0));
}

#include "media/free_flight_in_grids.glsl"

#ifndef HETEROGENEOUS_MEDIA
// u: chooses the channel, and the distance.
FreeFlight sample_free_flight(uint flags, Ray ray, float far, vec2 u) {
    FreeFlight flight;
    vec3 extinction = even_extinction(flags);
    float rate = extinction[min(int(3.0 * u.x), 2)];
    flight.distance = rate > 0.0 ? -log(max(1.0 - u.y, 1e-30)) / rate : INFINITY_DISTANCE;
    flight.transmittance = exp(-extinction * min(flight.distance, far));
    flight.pdf = flight.distance < far ? flight_pdf(extinction, flight.distance) : 0.0;
    return flight;
}

// The longest segment along which light is scattered evenly, meters: nothing is seen that far away.
const float MOST_EVEN = 1e10;

// Pdf of sample_scattered_flight, 1/m. Thin media are sampled evenly. thickness: of the media along the ray;
// transmittance: up to the distance.
float scattered_flight_pdf(uint flags, Ray ray, float far, float distance, vec3 thickness, out vec3 transmittance) {
    vec3 extinction = even_extinction(flags), scattered = 1.0 - exp(-thickness);
    transmittance = exp(-extinction * distance);
    vec3 densities = mix(extinction * transmittance / max(scattered, vec3(1e-30)), vec3(1.0 / min(far, MOST_EVEN)),
                         lessThanEqual(thickness, vec3(1e-3)));
    return dot(densities, vec3(1.0 / 3.0));
}

// A distance at which light is scattered before the end of the ray, which may be at INFINITY_DISTANCE.
float sample_scattered_flight(uint flags, Ray ray, float far, vec3 thickness, vec2 u) {
    int channel = min(int(3.0 * u.x), 2);
    float rate = even_extinction(flags)[channel], optical_depth = thickness[channel];
    return optical_depth > 1e-3 ? -log(max(1.0 - u.y * (1.0 - exp(-optical_depth)), 1e-30)) / rate
                                : min(far, MOST_EVEN) * u.y;
}
#endif
