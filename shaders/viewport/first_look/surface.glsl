// SPDX-License-Identifier: GPL-3.0-or-later
// A vertex of a plain surface on the camera's raster.

#include "camera_paths/gbuffer/projections.glsl"
#include <FirstLookParameters>
#include <FirstLookDrawn>

uniform Parameters { FirstLookParameters parameters; };
readonly buffer Camera;
readonly buffer PlainSurfaces;
readonly buffer InstanceOpacities;
#include "camera_paths/gbuffer/rasterize.glsl"

flat out uint material;
flat out uint instance;
flat out float opacity;
out float view_depth;
out vec3 to_viewer;
out vec3 normal;

// material_number, instance_number: of the triangle.
void place_vertex(vec3 point, vec3 surface_normal, uint material_number, uint instance_number) {
    material = material_number;
    instance = instance_number;
    normal = surface_normal;
    float instance_opacity = instance_opacities[instance_number];
    opacity = plain_surfaces[material_number].opacity * instance_opacity;
    to_viewer = camera.projection == PROJECTION_ORTHOGRAPHIC ? -camera.forward : camera.position - point;
    vec3 p = camera_space(point);
    view_depth = p.z;
    gl_Position = clip_position(p);
    // A holdout, of opacity 0, hides what is behind it; what is transparent is drawn when all else is there.
    bool solid = opacity >= 1.0 || instance_opacity == 0.0;
    bool drawn = (parameters.drawn & (solid ? DRAWN_SOLID : DRAWN_TRANSPARENT)) != 0u;
    if (instance_opacity < 0.0 || !drawn) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}
