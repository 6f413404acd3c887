// SPDX-License-Identifier: GPL-3.0-or-later
// The light that a shadow ray goes to, chosen by what each may give at a point, and the light objects that a ray
// passes (rppm_addon/integrator/lights/light_tree.py).

#include <LightNode>
#include "common/iteration.glsl"
#include "lights/lights.glsl"
#include "common/intersection.glsl"
#include "common/light_sets.glsl"
readonly buffer LightNodes { LightNode light_nodes[]; };

// Random numbers of 24 bits last for so many levels.
const uint LEVELS_OF_A_NUMBER = 12u;
// What gives little where nothing is in the way may be all that arrives: so much of the choice is even, between
// kinds of light, and on the whole way down a tree.
const float EVEN_FRACTION_OF_KINDS = 0.25, EVEN_FRACTION_OF_TREE = 0.2;

float sine_of(float cosine) { return sqrt(max(0.0, 1.0 - cosine * cosine)); }

// Cosine of the angle less another one, or of 0 when that is larger.
float cosine_of_difference(float cosine, float less_cosine) {
    return cosine > less_cosine ? 1.0 : cosine * less_cosine + sine_of(cosine) * sine_of(less_cosine);
}

// Where light is asked for: one side of the surface may be all that it can reach; in a light set. A point in a medium
// has a null normal.
struct LitPoint {
    vec3 position;
    vec3 normal;
    bool both_sides;
    uint light_set;
};

// The light set of the object that a triangle is of; 0 where lights shine on all alike.
uint light_set_at(uint triangle) {
    if (iteration.links_lights == 0u || triangle == NO_TRIANGLE) return 0u;
    return light_set_of(triangle_vertices[3u * triangle].w);
}

float facing(LitPoint point, vec3 direction) {
    float cosine = dot(point.normal, direction);
    return point.both_sides ? abs(cosine) : cosine;
}

// Irradiance, W/m^2, that the lights below a node may give: 0 only where they give none.
float node_importance(LightNode node, LitPoint point) {
    if (!(node.intensity > 0.0) || !has_set(node.light_sets, point.light_set)) return 0.0;
    vec3 to_center = 0.5 * (node.low + node.high) - point.position, half_size = 0.5 * (node.high - node.low);
    float distance2 = dot(to_center, to_center), radius2 = dot(half_size, half_size);
    if (distance2 <= radius2 * 1.0001) return node.intensity / max(radius2, 1e-20);
    vec3 direction = to_center * inversesqrt(distance2);
#ifdef MEDIA
    // The point stands for all points of a ray in a medium, which see the lights from other sides.
    if (point.normal == vec3(0.0)) return node.intensity / distance2;
#endif
    float cosine_bounds = sqrt(1.0 - radius2 / distance2);
    float received = cosine_of_difference(facing(point, direction), cosine_bounds);
    float leaving = -dot(node.axis, direction);
    if (node.two_sided != 0u) leaving = abs(leaving);
    float emitted = cosine_of_difference(cosine_of_difference(leaving, node.cosine_normals), cosine_bounds);
    if (received <= 0.0 || emitted < node.cosine_emission - 1e-3) return 0.0;
    return node.intensity * received * max(emitted, 1e-3) / distance2;
}

// Of a tree whose root is the first node but one: its children together know more than it does.
float tree_importance(uint first, uint leaves, LitPoint point) {
    uint begin = min(leaves, 2u), end = 2u * begin;
    float importance = 0.0;
    for (uint node = begin; node < end; ++node) importance += node_importance(light_nodes[first + node], point);
    return importance;
}

float sun_importance(LightNode sun, LitPoint point) {
    if (!has_set(sun.light_sets, point.light_set)) return 0.0;
#ifdef MEDIA
    if (point.normal == vec3(0.0)) return sun.intensity;
#endif
    return sun.intensity * max(0.0, cosine_of_difference(facing(point, -sun.axis), sun.cosine_normals));
}

// Number of the light among lights[], and of the triangle among emissive_triangles[]. probability 0: none gives any.
struct LightChoice {
    uint light;
    EmitterNumber triangle;
    float probability;
};

bool ray_meets_box(vec3 low, vec3 high, vec3 origin, vec3 inverse_direction, float maximum_distance) {
    vec3 at_low = (low - origin) * inverse_direction, at_high = (high - origin) * inverse_direction;
    vec3 enter = min(at_low, at_high), leave = max(at_low, at_high);
    return max(max(enter.x, enter.y), max(enter.z, 0.0)) <= min(min(leave.x, leave.y), min(leave.z, maximum_distance));
}

#include EMITTERS "lights/one_level/tree.glsl"

// Kinds of light that a choice is made among: the light objects' tree, the emissive triangles', the environment, and
// each sun.
const uint KIND_OBJECTS = 0u, KIND_TRIANGLES = 1u, KIND_ENVIRONMENT = 2u, KIND_FIRST_SUN = 3u;

float kind_importance(uint kind, LitPoint point, float environment_irradiance) {
    if (kind >= KIND_FIRST_SUN) return sun_importance(light_nodes[iteration.first_sun + kind - KIND_FIRST_SUN], point);
    if (kind == KIND_ENVIRONMENT) return environment_irradiance;
    bool objects = kind == KIND_OBJECTS;
    return tree_importance(objects ? 0u : iteration.triangle_tree,
                           objects ? iteration.light_tree_leaves : iteration.triangle_tree_leaves, point);
}

// Of a kind among all: so many shine, and their importances come to a total.
float kind_probability(float importance, float total, float shining) {
    return (1.0 - EVEN_FRACTION_OF_KINDS) * importance / total + EVEN_FRACTION_OF_KINDS / shining;
}

// Irradiance that the environment counts for in the choice of a light, W/m^2. An even one is left to gathering rays.
float chosen_environment_irradiance(vec3 position, bool gathers) {
    float irradiance = gathers && environment_is_even() ? 0.0 : iteration.environment_irradiance;
#ifdef PORTALS
    // Through portals shadow rays find it as well.
    irradiance = portal_irradiance(position, irradiance);
#endif
    return irradiance;
}

// Probability with which choose_light_at comes to a light that has a place in a tree, as that leaf, or to a sun.
float light_probability(LitPoint point, float environment_irradiance, uint kind, EmitterNumber leaf) {
    float total = 0.0, shining = 0.0, own = 0.0;
    for (uint other = 0u; other < KIND_FIRST_SUN + iteration.sun_count; ++other) {
        float importance = kind_importance(other, point, environment_irradiance);
        if (other == kind) own = importance;
        total += importance;
        shining += importance > 0.0 ? 1.0 : 0.0;
    }
    if (!(own > 0.0)) return 0.0;
    float probability = kind_probability(own, total, shining);
    if (kind >= KIND_FIRST_SUN) return probability;
    bool objects = kind == KIND_OBJECTS;
    return probability
           * leaf_probability(objects ? 0u : iteration.triangle_tree,
                              objects ? iteration.light_tree_leaves : iteration.triangle_tree_leaves, point, leaf);
}

// environment_irradiance: what the environment counts for, W/m^2. u_deep takes over where u has been used up.
LightChoice choose_light_at(LitPoint point, float environment_irradiance, float u, float u_deep) {
    uint kinds = KIND_FIRST_SUN + iteration.sun_count;
    float total = 0.0, shining = 0.0;
    // The first sun's is kept as well: most scenes have no other.
    vec4 importances = vec4(0.0);
    for (uint kind = 0u; kind < kinds; ++kind) {
        float importance = kind_importance(kind, point, environment_irradiance);
        if (kind < 4u) importances[kind] = importance;
        total += importance;
        shining += importance > 0.0 ? 1.0 : 0.0;
    }
    LightChoice choice = LightChoice(0u, in_world(0u), 0.0);
    if (!(total > 0.0)) return choice;
    uint chosen = kinds;
    for (uint kind = 0u; kind < kinds; ++kind) {
        float importance = kind < 4u ? importances[kind]
                                     : sun_importance(light_nodes[iteration.first_sun + kind - KIND_FIRST_SUN], point);
        if (!(importance > 0.0)) continue;
        float probability = kind_probability(importance, total, shining);
        chosen = kind;
        choice.probability = probability;
        if (u < probability) break;
        u -= probability;
    }
    u = clamp(u / choice.probability, 0.0, 0.99999994);
    if (chosen == KIND_ENVIRONMENT) choice.light = iteration.world_light;
    else if (chosen >= KIND_FIRST_SUN) choice.light = light_nodes[iteration.first_sun + chosen - KIND_FIRST_SUN].member;
    else {
        bool objects = chosen == KIND_OBJECTS;
        EmitterNumber member = in_world(0u);
        choice.probability *= choose_leaf(objects ? 0u : iteration.triangle_tree,
                                          objects ? iteration.light_tree_leaves : iteration.triangle_tree_leaves, point,
                                          u, u_deep, member);
        choice.light = objects ? emitter_number(member) : iteration.mesh_light;
        if (!objects) choice.triangle = member;
    }
    return choice;
}

// --- light objects that a ray passes ---------------------------------------------------------------

// Where a ray was scattered that may meet lights, as shadow rays from there choose among these.
struct ScatterPoint {
    LitPoint lit;
    float environment_irradiance;  // W/m^2, as choose_light_at was given it
    float pdf;                     // of the ray's direction, 1/sr; 0 where no shadow rays look for the same light
    bool gathers;                  // whether the ray gathers: it leaves some lights to shadow rays (is_shared_light)
    uint bounces;                  // of the path there
};

// Light objects along a ray: the radiance of all, and that of one of them, chosen by the random number u, over its
// probability; its number and its distance.
struct IntersectedLights {
    vec3 radiance;
    vec3 chosen;
    uint light;
    float distance;
    float weights;
    float u;
};

// kind, leaf: by which shadow rays choose the light.
void intersect_light(inout IntersectedLights sum, uint number, uint kind, uint leaf, ScatterPoint from, vec3 direction,
                     vec2 distances, uint ray, uint media_flags) {
    Light light = lights[number];
    vec3 origin = from.lit.position;
    if ((light.flags & ray & RAYS_WITH_VISIBILITY) == 0u) return;
    if (from.gathers && !is_shared_light(light, from.bounces)) return;
    float distance, pdf;
    vec3 radiance = intersected_radiance(light, origin, direction, distances.y, distance, pdf);
    if (distance <= distances.x && light.kind != LIGHT_SUN) return;
    float way = light.kind == LIGHT_SUN ? INFINITY_DISTANCE : distance - distances.x;
    if (from.pdf > 0.0 && largest(radiance) > 0.0)
        pdf *= light_probability(from.lit, from.environment_irradiance, kind, in_world(leaf));
    radiance *= segment_transmittance(media_flags, origin + distances.x * direction, direction, way)
                * scatter_mis_weight(from.pdf, pdf);
    sum.radiance += radiance;
#ifdef REPORT_INTERSECTED_LIGHT
    REPORT_INTERSECTED_LIGHT(number, radiance);
#endif
    float weight = largest(radiance);
    if (!(weight > 0.0)) return;
    sum.weights += weight;
    if (!reservoir_accept(weight, sum.weights, sum.u)) return;
    sum.chosen = radiance / weight;
    sum.light = number;
    sum.distance = light.kind == LIGHT_SUN ? INFINITY_DISTANCE : distance;
}

// Intersects a ray with the light objects between two distances. They occlude nothing, and the camera sees all. from:
// in the light set of an object. media_flags: flags of a path in the media that the ray crosses from the nearer of the
// distances on. Suns first, then down the tree: one loop, since drivers without calls have the code of a light as often
// as it stands here.
IntersectedLights intersect_lights(ScatterPoint from, vec3 direction, vec2 distances, uint ray, float u,
                                   uint media_flags) {
    IntersectedLights sum = IntersectedLights(vec3(0.0), vec3(0.0), 0u, 0.0, 0.0, u);
    vec3 inverse_direction = 1.0 / mix(direction, vec3(1e-20), lessThan(abs(direction), vec3(1e-20)));
    uint sun = distances.y >= INFINITY_DISTANCE ? 0u : iteration.sun_count;
    uint node = iteration.light_tree_leaves > 0u ? 1u : 0u;  // 0: none left
    while (sun < iteration.sun_count || node > 0u) {
        bool is_sun = sun < iteration.sun_count;
        LightNode at = light_nodes[is_sun ? iteration.first_sun + sun : node];
        bool met = is_sun
                   || (at.intensity > 0.0
                       && ray_meets_box(at.low, at.high, from.lit.position, inverse_direction, distances.y));
        uint kind = is_sun ? KIND_FIRST_SUN + sun : KIND_OBJECTS, leaf = node;
        if (is_sun) sun += 1u;
        else if (met && node < iteration.light_tree_leaves) {
            node *= 2u;
            met = false;
        } else {
            // The node beside it, or beside the nearest one above that has one.
            node += 1u;
            node >>= uint(findLSB(node));
            if (node == 1u) node = 0u;
        }
        if (met && ((ray & RAY_CAMERA) != 0u || has_set(at.light_sets, from.lit.light_set)))
            intersect_light(sum, at.member, kind, leaf, from, direction, distances, ray, media_flags);
    }
    return sum;
}

// Radiance of the light objects that a ray intersects on its way through a medium. from: where it was scattered.
vec3 visible_light(ScatterPoint from, Ray way, float far, uint ray, uint media_flags) {
    float gone = distance(from.lit.position, way.origin);
    return intersect_lights(from, way.direction, vec2(gone, gone + far), ray, 0.0, media_flags).radiance;
}
