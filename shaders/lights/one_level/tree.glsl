// SPDX-License-Identifier: GPL-3.0-or-later
// Walks of light trees, all of whose leaves are lights or world triangles. lights/two_levels/tree.glsl stands in for
// this file where some are instances.

// Down a tree: sets the leaf's member, and returns its probability.
float choose_leaf(uint first, uint leaves, LitPoint point, float u, float u_deep, out EmitterNumber member) {
    float probability = 1.0, even_fraction = EVEN_FRACTION_OF_TREE / float(max(findMSB(2u * leaves - 1u), 1));
    uint node = 1u;
    for (uint level = 1u; node < leaves; ++level) {
        float low = node_importance(light_nodes[first + 2u * node], point),
              high = node_importance(light_nodes[first + 2u * node + 1u], point);
        if (!(low + high > 0.0)) return 0.0;
        float low_probability = low / (low + high);
        if (low > 0.0 && high > 0.0) low_probability = mix(low_probability, 0.5, even_fraction);
        bool goes_low = u < low_probability;
        u = goes_low ? u / low_probability : (u - low_probability) / (1.0 - low_probability);
        if (level == LEVELS_OF_A_NUMBER) u = u_deep;
        u = clamp(u, 0.0, 0.99999994);
        probability *= goes_low ? low_probability : 1.0 - low_probability;
        node = 2u * node + (goes_low ? 0u : 1u);
    }
    member = light_nodes[first + node].member;
    return probability;
}

// Probability with which choose_leaf comes to the leaf that is node `leaf` of a tree.
float leaf_probability(uint first, uint leaves, LitPoint point, EmitterNumber leaf) {
    float probability = 1.0, even_fraction = EVEN_FRACTION_OF_TREE / float(max(findMSB(2u * leaves - 1u), 1));
    for (int level = findMSB(leaf); level > 0; --level) {
        uint node = leaf >> uint(level);
        float low = node_importance(light_nodes[first + 2u * node], point),
              high = node_importance(light_nodes[first + 2u * node + 1u], point);
        if (!(low + high > 0.0)) return 0.0;
        float low_probability = low / (low + high);
        if (low > 0.0 && high > 0.0) low_probability = mix(low_probability, 0.5, even_fraction);
        probability *= ((leaf >> uint(level - 1)) & 1u) == 0u ? low_probability : 1.0 - low_probability;
    }
    return probability;
}

// The nearest of those that smooth surfaces look for, as a hit of the watertight test; from_triangle: where the ray
// begins, which it does not meet; on an object in a light set. emissive: its number among emissive_triangles[].
Hit intersect_emitters(vec3 origin, vec3 direction, uint from_triangle, uint light_set, out EmitterNumber emissive) {
    Hit nearest = Hit(NO_TRIANGLE, 0.0, 0.0, INFINITY_DISTANCE);
    if (iteration.triangle_tree_leaves == 0u) return nearest;
    WatertightRay ray = make_watertight_ray(origin, direction);
    vec3 inverse_direction = 1.0 / mix(direction, vec3(1e-20), lessThan(abs(direction), vec3(1e-20)));
    uint node = 1u;
    do {
        LightNode at = light_nodes[iteration.triangle_tree + node];
        bool met = at.intensity > 0.0 && ray_meets_box(at.low, at.high, origin, inverse_direction, nearest.distance);
        if (met && node < iteration.triangle_tree_leaves) {
            node *= 2u;
            continue;
        }
        uint triangle = met ? emissive_triangles[at.member].triangle : NO_TRIANGLE;
        met = met && has_set(at.light_sets, light_set);
        if (met && triangle != from_triangle && (emissive_triangles[at.member].traits & EMITTER_REFLECTED) != 0u) {
            vec3 v0, v1, v2;
            triangle_corners(triangle, v0, v1, v2);
            intersect_triangle(ray, triangle, v0, v1, v2, nearest);
            if (nearest.triangle == triangle) emissive = at.member;
        }
        node += 1u;
        node >>= uint(findLSB(node));
    } while (node > 1u);
    return nearest;
}

// The triangle that intersect_emitters has found, as emitters are numbered.
EmitterNumber met_triangle(Hit hit, EmitterNumber emissive) { return hit.triangle; }
