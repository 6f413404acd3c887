#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// A plain surface under a light at the viewer's head and a sky of the world's mean color. Premultiplied.

#include "camera_paths/gbuffer/projections.glsl"
#include <FirstLookParameters>

uniform Parameters { FirstLookParameters parameters; };
readonly buffer Camera;
readonly buffer PlainSurfaces;
#include "camera_paths/gbuffer/rasterize.glsl"

flat in uint material;
flat in uint instance;
flat in float opacity;
in float view_depth;
in vec3 to_viewer;
in vec3 normal;
layout(location = 0) out vec4 combined;
layout(location = 1) out vec4 surface_seen;    // normal toward the viewer, and view depth
layout(location = 2) out vec2 surface_number;  // which instance, from 1, and material, odd where it is specular

const float SPECULAR_ROUGHNESS = 0.5;

// The lower half of the surroundings is half as bright.
vec3 surroundings(float height) { return parameters.sky * (0.75 + 0.25 * height); }

void main() {
    gl_FragDepth = fragment_depth(view_depth);
    PlainSurface surface = plain_surfaces[material];
    vec3 viewer = normalize(to_viewer), n = normalize(normal);
    if (dot(n, viewer) < 0.0) n = -n;
    float facing = dot(n, viewer);
    // GGX seen from where its light is: the half vector is the viewer's direction.
    float alpha2 = max(pow(surface.roughness, 4.0), 0.01), slope = facing * facing * (alpha2 - 1.0) + 1.0;
    vec3 f0 = mix(vec3(0.04), surface.color, surface.metallic);
    vec3 diffuse = surface.color * (1.0 - surface.metallic);
    vec3 light = parameters.headlight * facing * (diffuse + 0.25 * f0 * min(alpha2 / (slope * slope), 4.0));
    light += diffuse * surroundings(n.z) + f0 * surroundings(2.0 * facing * n.z - viewer.z);
    float alpha = max(opacity, 0.0);
    combined = vec4(alpha * (light + parameters.exposure * surface.emission), alpha);
    bool specular = surface.opacity < 1.0 || (surface.metallic > 0.5 && surface.roughness < SPECULAR_ROUGHNESS);
    surface_seen = vec4(n, view_depth);
    surface_number = vec2(instance + 1u, 2u * material + (specular ? 1u : 0u));
}
