// SPDX-License-Identifier: GPL-3.0-or-later
// The boxes of instances in the world, which stand for them in the cells of the top level.
#include "deep_cubemap/state.glsl"

restrict readonly buffer InstanceBoxes;

// About the center.
struct InstanceBox {
    vec3 low, high;
};

InstanceBox instance_box(uint number) {
    return InstanceBox(instance_boxes[2u * number].xyz - deep_cubemap.center,
                       instance_boxes[2u * number + 1u].xyz - deep_cubemap.center);
}

bool has_center(InstanceBox box) {
    return all(lessThanEqual(box.low, vec3(deep_cubemap.margin)))
           && all(greaterThanEqual(box.high, vec3(-deep_cubemap.margin)));
}

// One of the twelve triangles, two a side.
void box_triangle(InstanceBox box, uint number, out vec3 a, out vec3 b, out vec3 c) {
    uint axis = number >> 2;
    vec3 fixed_axis = vec3(equal(uvec3(axis), uvec3(0u, 1u, 2u)));
    vec3 across = fixed_axis.zxy, along = fixed_axis.yzx;
    vec3 place = (number & 2u) != 0u ? fixed_axis : vec3(0.0);
    a = mix(box.low, box.high, place);
    b = mix(box.low, box.high, place + across + along);
    c = mix(box.low, box.high, place + ((number & 1u) != 0u ? across : along));
}
