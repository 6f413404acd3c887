// SPDX-License-Identifier: GPL-3.0-or-later
// Walks of light trees in two levels: a leaf of the top-level tree is a light, a world triangle, or an instance, whose
// mesh has a tree of its own in object space. Probabilities are the products of both levels'.
#include <EmitterInstances>

// A node of the tree of an instance's mesh in the world: its box holds the placed one, and its cone the placed normals.
// Angles between vectors grow by a linear map so that the tangents of their halves grow by no more than its condition
// number, whose square is `stretch`.
LightNode placed_node(LightNode node, EmitterInstance instance) {
    mat3 linear = instance_linear(instance);
    vec3 center = placed(instance, 0.5 * (node.low + node.high));
    vec3 extent = mat3(abs(linear[0]), abs(linear[1]), abs(linear[2])) * (0.5 * (node.high - node.low));
    extent += 1e-6 * largest(abs(center));
    node.low = center - extent;
    node.high = center + extent;
    vec3 axis = mat3(cross(linear[1], linear[2]), cross(linear[2], linear[0]), cross(linear[0], linear[1])) * node.axis;
    float scale = max(length(axis), 1e-30);
    node.axis = axis / scale;
    node.intensity *= scale;
    float one_minus_cosine = instance.stretch * (1.0 - node.cosine_normals);
    node.cosine_normals =
        (1.0 + node.cosine_normals - one_minus_cosine) / (1.0 + node.cosine_normals + one_minus_cosine);
    return node;
}

// A tree that is walked: that of an instance's mesh, or of the top level.
struct WalkedTree {
    uint first;
    uint leaves;
    float even_fraction;
    bool in_mesh;
    EmitterInstance instance;
};

float even_fraction_of(uint leaves) { return EVEN_FRACTION_OF_TREE / float(max(findMSB(2u * leaves - 1u), 1)); }

void enter_mesh(inout WalkedTree tree, uint number) {
    tree.instance = emitter_instance(number);
    tree.first = tree.instance.tree;
    tree.leaves = tree.instance.leaves;
    tree.even_fraction = even_fraction_of(tree.leaves);
    tree.in_mesh = true;
}

void enter_top_level(inout WalkedTree tree, uint first, uint leaves) {
    tree.first = first;
    tree.leaves = leaves;
    tree.even_fraction = even_fraction_of(leaves);
    tree.in_mesh = false;
}

LightNode walked_node(WalkedTree tree, uint node) {
    LightNode at = light_nodes[tree.first + node];
    if (tree.in_mesh) at = placed_node(at, tree.instance);
    return at;
}

// Probability of the lower child of a node; below 0 where nothing below the node gives light.
float low_child_probability(WalkedTree tree, uint node, LitPoint point) {
    vec2 importance = vec2(0.0);
    for (uint side = 0u; side < 2u; ++side)
        importance[side] = node_importance(walked_node(tree, 2u * node + side), point);
    float total = importance.x + importance.y;
    if (!(total > 0.0)) return -1.0;
    float probability = importance.x / total;
    return importance.x > 0.0 && importance.y > 0.0 ? mix(probability, 0.5, tree.even_fraction) : probability;
}

// Down a tree, and on down the mesh's where it ends at an instance: sets the leaf's member, and returns its
// probability.
float choose_leaf(uint first, uint leaves, LitPoint point, float u, float u_deep, out EmitterNumber member) {
    float probability = 1.0;
    uint node = 1u, number = NO_TRIANGLE, level = 0u;
    member = in_world(0u);
    WalkedTree tree;
    enter_top_level(tree, first, leaves);
    while (true) {
        if (node >= tree.leaves) {
            uint reached = light_nodes[tree.first + node].member;
            if (tree.in_mesh) reached += tree.instance.first_emitter;
            member = uvec2(number, reached);
            if (tree.in_mesh || (reached & INSTANCE_MEMBER) == 0u) return probability;
            number = reached & ~INSTANCE_MEMBER;
            enter_mesh(tree, number);
            node = 1u;
            continue;
        }
        float low_probability = low_child_probability(tree, node, point);
        if (low_probability < 0.0) return 0.0;
        bool goes_low = u < low_probability;
        u = goes_low ? u / low_probability : (u - low_probability) / (1.0 - low_probability);
        level += 1u;
        if (level == LEVELS_OF_A_NUMBER) u = u_deep;
        if (level == 2u * LEVELS_OF_A_NUMBER)
            u = unit_float(pcg4d(uvec4(floatBitsToUint(u_deep), floatBitsToUint(u), number, node)).x);
        u = clamp(u, 0.0, 0.99999994);
        probability *= goes_low ? low_probability : 1.0 - low_probability;
        node = 2u * node + (goes_low ? 0u : 1u);
    }
}

// Probability with which choose_leaf comes to a leaf: up the mesh's tree, then up the other.
float leaf_probability(uint first, uint leaves, LitPoint point, EmitterNumber leaf) {
    float probability = 1.0;
    WalkedTree tree;
    enter_top_level(tree, first, leaves);
    if (is_of_instance(leaf)) enter_mesh(tree, leaf.x);
    uint below = leaf.y;
    while (true) {
        if (below <= 1u) {
            if (!tree.in_mesh) return probability;
            below = tree.instance.leaf;
            enter_top_level(tree, first, leaves);
            continue;
        }
        float low_probability = low_child_probability(tree, below >> 1u, point);
        if (low_probability < 0.0) return 0.0;
        probability *= (below & 1u) == 0u ? low_probability : 1.0 - low_probability;
        below >>= 1u;
    }
}

// Whether a ray meets an emissive triangle at a leaf, nearer than what it has met.
bool meets_leaf(WatertightRay ray, EmitterNumber from, EmitterNumber emitter, inout Hit nearest) {
    EmitterNumber triangle;
    vec3 v0, v1, v2;
    EmissiveTriangle emissive = read_emitter(emitter, triangle, v0, v1, v2);
    if (triangle == from || (emissive.traits & EMITTER_REFLECTED) == 0u) return false;
    float before = nearest.distance;
    Hit found = Hit(NO_TRIANGLE, 0.0, 0.0, before);
    intersect_triangle(ray, emitter.y, v0, v1, v2, found);
    if (found.triangle == NO_TRIANGLE) return false;
    nearest = found;
    return true;
}

// The nearest of those that smooth surfaces look for, as a hit of the watertight test; from_triangle: where the ray
// begins, which it does not meet; on an object in a light set. emissive: its number among emissive_triangles[].
Hit intersect_emitters(vec3 origin, vec3 direction, uint from_triangle, uint light_set, out EmitterNumber emissive) {
    Hit nearest = Hit(NO_TRIANGLE, 0.0, 0.0, INFINITY_DISTANCE);
    uint first = iteration.triangle_tree, leaves = iteration.triangle_tree_leaves;
    if (leaves == 0u) return nearest;
    WatertightRay ray = make_watertight_ray(origin, direction);
    vec3 inverse_direction = 1.0 / mix(direction, vec3(1e-20), lessThan(abs(direction), vec3(1e-20)));
    EmitterNumber from = hit_emitter(from_triangle);
    uint node = 1u, number = NO_TRIANGLE, entered = 1u;
    WalkedTree tree;
    enter_top_level(tree, first, leaves);
    while (true) {
        LightNode at = walked_node(tree, node);
        bool met = at.intensity > 0.0 && ray_meets_box(at.low, at.high, origin, inverse_direction, nearest.distance);
        if (met && node < tree.leaves) {
            node *= 2u;
            continue;
        }
        met = met && has_set(at.light_sets, light_set);
        if (met && !tree.in_mesh && (at.member & INSTANCE_MEMBER) != 0u) {
            number = at.member & ~INSTANCE_MEMBER;
            entered = node;
            enter_mesh(tree, number);
            node = 1u;
            continue;
        }
        if (met) {
            EmitterNumber emitter =
                tree.in_mesh ? uvec2(number, tree.instance.first_emitter + at.member) : in_world(at.member);
            if (meets_leaf(ray, from, emitter, nearest)) emissive = emitter;
        }
        node += 1u;
        node >>= uint(findLSB(node));
        if (node == 1u && tree.in_mesh) {
            enter_top_level(tree, first, leaves);
            node = entered + 1u;
            node >>= uint(findLSB(node));
        }
        if (node == 1u) return nearest;
    }
}

// The triangle that intersect_emitters has found, as emitters are numbered.
EmitterNumber met_triangle(Hit hit, EmitterNumber emissive) {
    if (!is_of_instance(emissive)) return in_world(emissive_triangles[emissive.y].triangle);
    return uvec2(emissive.x, emissive.y - emitter_instance(emissive.x).first_emitter);
}
