// SPDX-License-Identifier: GPL-3.0-or-later
// What nodes ask of rays (rppm_addon/integrator/surfaces/node_rays.py); texts of materials with such nodes include it.
//
// A hit is evaluated once for each level of such nodes, to ask, and then once more with all that was found.

#define NODE_RAYS
#include <NodeRay>
#include <NodeRayQueries>
#include <PathKinds>
buffer NodeRays;

uint path_of_node_rays;

bool asks_rays() { return parameters.ray_level < parameters.ray_levels; }

// The sum over all rays; without meaning until the level was traced.
vec3 found_by_rays(uint place, uint level, uint kind, uint samples, vec3 direction, float reach) {
    uint at = parameters.ray_stride * path_of_node_rays + place;
    if (parameters.ray_level == level)
        node_rays[at] =
            NodeRay(direction, kind | level << QUERY_LEVEL_SHIFT | samples << QUERY_SAMPLES_SHIFT, vec3(0.0), reach);
    return node_rays[at].found;
}
