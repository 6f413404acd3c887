// SPDX-License-Identifier: GPL-3.0-or-later
// The instance of a hit where rays place instances in the world. Their attributes are not gathered: a kernel that looks
// at hits itself only gives them no numbers that others see (acceleration/instances.glsl). The includer declares the
// block Attributes before.

uint instance_of(uint triangle) {
    uvec2 origin;
    if (!find_origin(triangle, origin)) return attributes[triangle].instance;
    return bottom_level_instances[origin.x].placement;
}
