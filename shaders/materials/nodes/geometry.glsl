// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes about the place, the object and the path. Needs the camera members of the parameters.

#include "common/differential_frame.glsl"

vec3 to_camera(vec3 p) { return (parameters.world_to_camera * vec4(p, 1.0)).xyz; }

// Meters across what a pixel sees of a place that faces it.
float pixel_width(Surface surface) {
    return parameters.pixel_size * (parameters.orthographic != 0u ? 1.0 : surface.ray_length);
}

// The same of a place that the camera sees itself: away from the middle of a picture pixels see less. As in Cycles, the
// mean of what one pixel to the side and one upward turn the ray by.
float seen_pixel_width(Surface surface) {
    vec3 at = to_camera(surface.position);
    if (parameters.orthographic != 0u || at.z == 0.0 || (surface.ray & RAY_CAMERA) == 0u) return pixel_width(surface);
    vec2 slope2 = at.xy * at.xy / (at.z * at.z);
    return pixel_width(surface) * dot(sqrt(1.0 + slope2), vec2(0.5)) / (1.0 + slope2.x + slope2.y);
}

void node_tex_coord(Surface surface, out vec3 normal, out vec3 uv, out vec3 object, out vec3 camera, out vec3 window,
                    out vec3 reflection) {
    bool world = surface.instance == NO_INSTANCE;
    object = point_to_object(surface, surface.position);
    vec3 n = normal_to_object(surface, surface.normal);
    normal = n / max(length(n), 1e-20);
    uv = vec3(surface.uv, 0.0);
    camera = world ? mat3(parameters.world_to_camera) * surface.position : to_camera(surface.position);
    camera.z = -camera.z;
    vec2 plane = parameters.orthographic != 0u
                     ? camera.xy
                     : camera.xy / (camera.z < 0.0 ? min(camera.z, -1e-20) : max(camera.z, 1e-20));
    window = vec3((plane - parameters.window.xz) / (parameters.window.yw - parameters.window.xz), 0.0);
    reflection = world ? surface.viewer : 2.0 * dot(surface.normal, surface.viewer) * surface.normal - surface.viewer;
}

// Coordinates in the space of another object, whose world-to-object rows are the inputs.
void node_object_coord(Surface surface, vec3 row0, vec3 row1, vec3 row2, vec3 offset, out vec3 object) {
    vec3 at = world_position(surface);
    object = vec3(dot(row0, at), dot(row1, at), dot(row2, at)) + offset;
}

void node_uvmap(Surface surface, uint layer, out vec3 uv) { uv = vec3(attribute_value(surface, layer).xy, 0.0); }

void attribute_outputs(vec4 value, uvec2 place, out vec3 color, out vec3 vector, out float fac, out float alpha) {
    color = vector = value.rgb;
    fac = place.y == 1u ? value.x : mean(value.rgb);
    alpha = value.a;
}

void node_attribute(Surface surface, uint layer, out vec3 color, out vec3 vector, out float fac, out float alpha) {
    vec4 value = attribute_value(surface, layer);
    attribute_outputs(value, attribute_place(surface, layer), color, vector, fac, alpha);
}

void node_grid_attribute(Surface surface, uint layer, out vec3 color, out float fac) {
    vec3 vector;
    float alpha;
    node_attribute(surface, layer, color, vector, fac, alpha);
    if (attribute_place(surface, layer).y > 0u) return;
    color = vec3(1.0);
    fac = 1.0;
}

void node_generated_coord(Surface surface, uint layer, out vec3 generated) {
    generated =
        attribute_place(surface, layer).y > 0u ? attribute_value(surface, layer).xyz : within_texture_space(surface);
}

void node_random_per_island(Surface surface, uint layer, out float random) {
    random = attribute_value(surface, layer).x;
}

void node_new_geometry(Surface surface, out vec3 position, out vec3 normal, out vec3 tangent, out vec3 true_normal,
                       out vec3 incoming, out vec3 parametric, out float backfacing) {
    position = world_position(surface);
    normal = surface.normal;
    true_normal = surface.geometric;
    incoming = surface.viewer;
    parametric = vec3(surface.barycentrics.x, surface.barycentrics.y, 0.0);
    backfacing = surface.backfacing ? 1.0 : 0.0;
    tangent = default_tangent(surface);
#ifdef ROUND_SHAPES
    if (is_strand(surface)) true_normal = surface.viewer;  // ribbons face it
#endif
}

void node_tangent(Surface surface, int direction_type, int axis, uint layer, out vec3 tangent) {
    vec3 found = attribute_value(surface_itself(surface), layer).xyz, at = found - 0.5;
    if (direction_type == 0)
        found = axis == 0 ? vec3(0.0, -at.z, at.y) : (axis == 1 ? vec3(-at.z, 0.0, at.x) : vec3(-at.y, at.x, 0.0));
    tangent = surface_tangent(surface, found);
}

void node_object_info(Surface surface, float material_index, out vec3 location, out vec3 color, out float alpha,
                      out float object_index, out float material_index_out, out float random) {
    ShadingInstance at = shading_instances[surface.instance == NO_INSTANCE ? 0u : surface.instance];
    location = at.location + parameters.world_origin;
    color = at.color.rgb;
    alpha = at.color.a;
    object_index = float(at.object_index);
    material_index_out = material_index;
    random = at.random;
}

void node_particle_info(Surface surface, out float index, out float random, out float age, out float lifetime,
                        out vec3 location, out float size, out vec3 velocity, out vec3 angular_velocity) {
    ShadingInstance at = shading_instances[surface.instance == NO_INSTANCE ? 0u : surface.instance];
    index = at.particle_index;
    random = at.particle_random;
    age = at.particle_age;
    lifetime = at.particle_lifetime;
    location = at.particle_location;
    size = at.particle_size;
    velocity = at.particle_velocity;
    angular_velocity = at.particle_angular_velocity;
}

// A number of each strand, place along it, or point; other surfaces have none.
void node_strand_value(Surface surface, uint layer, out float value) { value = attribute_value(surface, layer).x; }

void node_hair_info(Surface surface, out float is_strand_out, out vec3 tangent_normal) {
    is_strand_out = 0.0;
    tangent_normal = vec3(0.0);
#ifdef ROUND_SHAPES
    if (!is_strand(surface)) return;
    is_strand_out = 1.0;
    tangent_normal = strand_at(surface).across;
#endif
}

void node_point_position(Surface surface, uint layer, out vec3 position) {
    position = vec3(0.0);
    if (attribute_place(surface, layer).y == 0u) return;
    position =
        world_position(surface)
        + direction_to_world(surface, attribute_value(surface, layer).xyz - point_to_object(surface, surface.position));
}

// A length across a strand or point: as in Cycles as large as the instance makes it along the diagonal.
void node_round_size(Surface surface, uint layer, out float size) {
    float own = attribute_value(surface, layer).x;
    size = own > 0.0 ? length(direction_to_world(surface, vec3(own / sqrt(3.0)))) : 0.0;
}

void node_camera(Surface surface, out vec3 view_vector, out float view_z_depth, out float view_distance) {
    vec3 at = to_camera(surface.position);
    at.z = -at.z;
    view_distance = length(at);
    view_vector = at / max(view_distance, 1e-20);
    view_z_depth = abs(at.z);
}

// Nothing but the camera path's own rays has a depth.
void node_light_path(Surface surface, out float is_camera_ray, out float is_shadow_ray, out float is_diffuse_ray,
                     out float is_glossy_ray, out float is_singular_ray, out float is_reflection_ray,
                     out float is_transmission_ray, out float is_volume_scatter_ray, out float ray_length,
                     out float ray_depth, out float diffuse_depth, out float glossy_depth, out float transparent_depth,
                     out float transmission_depth, out float portal_depth) {
    is_camera_ray = (surface.ray & RAY_CAMERA) != 0u ? 1.0 : 0.0;
    is_diffuse_ray = (surface.ray & RAY_DIFFUSE) != 0u ? 1.0 : 0.0;
    is_glossy_ray = (surface.ray & RAY_GLOSSY) != 0u ? 1.0 : 0.0;
    is_singular_ray = (surface.ray & RAY_SINGULAR) != 0u ? 1.0 : 0.0;
    is_transmission_ray = (surface.ray & RAY_TRANSMISSION) != 0u ? 1.0 : 0.0;
    is_reflection_ray = is_glossy_ray > 0.0 || is_diffuse_ray > 0.0 ? 1.0 - is_transmission_ray : 0.0;
    is_shadow_ray = (surface.ray & RAY_SHADOW) != 0u ? 1.0 : 0.0;
    is_volume_scatter_ray = 0.0;
    ray_length = surface.ray_length;
    ray_depth = float(surface.ray_depth);
    transparent_depth = float(surface.transparent_depth);
    portal_depth = float(surface.portal_depth);
    diffuse_depth = float(count_of(surface.bounce_counts, SCATTER_DIFFUSE));
    glossy_depth = float(count_of(surface.bounce_counts, SCATTER_GLOSSY));
    transmission_depth = float(count_of(surface.bounce_counts, SCATTER_TRANSMISSION));
}

void node_wireframe(Surface surface, int pixel_size, float size, out float fac) {
    vec3 v0, v1, v2;
    triangle_points(surface.triangle, v0, v1, v2);
    float area2 = length(cross(v1 - v0, v2 - v0));
    vec3 heights =
        surface.barycentrics * area2 / max(vec3(length(v2 - v1), length(v2 - v0), length(v1 - v0)), vec3(1e-20));
    float width = size;
    if (pixel_size != 0) {
        // What a pixel covers across the viewing ray, the mean of two directions on the surface.
        vec3 x, y;
        differential_frame(surface.geometric, x, y);
        vec2 along = vec2(dot(x, surface.viewer), dot(y, surface.viewer));
        width *= seen_pixel_width(surface) * dot(sqrt(max(1.0 - along * along, 0.0)), vec2(0.5));
    }
    fac = min(heights.x, min(heights.y, heights.z)) < 0.5 * width ? 1.0 : 0.0;
}
