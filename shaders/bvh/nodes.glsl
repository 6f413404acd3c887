// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes of bounding volume hierarchies, and the way of a ray from one to its children.
#include "bvh/boxes.glsl"
#include <BvhNodes>

restrict readonly buffer BvhNodes;

// Children of a node that a ray meets.
struct MetChildren {
    uint nearer;  // where it meets any
    uint farther;
    bool any, both;
};

MetChildren met_children(BvhNode node, SlabTest slabs, float distance) {
    float enter0, enter1;
    bool meets0 = meets_box(slabs, node.low0, node.high0, distance, enter0);
    bool meets1 = meets_box(slabs, node.low1, node.high1, distance, enter1);
    bool is_second_first = meets1 && (!meets0 || enter1 < enter0);
    return MetChildren(is_second_first ? node.child1 : node.child0, is_second_first ? node.child0 : node.child1,
                       meets0 || meets1, meets0 && meets1);
}
