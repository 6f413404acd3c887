# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes milk.blend: a glass of milk under a lamp, with a mean free path of seven millimeters."""

import math

from stage import (
    ball,
    camera,
    color_world,
    glass,
    lathe,
    light,
    plate,
    save,
    set_up,
    smooth_line,
    varnished,
    wood,
)
from volumes import scattering, set_volume_bounces

BOUNCES, LEVEL = 16, 0.082


def milk():
    """A medium behind a clear surface."""
    made = scattering("Milk", (0.995, 0.975, 0.93), 140.0)
    tree = made.node_tree
    surface = tree.nodes.new("ShaderNodeBsdfGlass")
    surface.inputs["IOR"].default_value, surface.inputs["Roughness"].default_value = 1.35, 0.0
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    tree.links.new(surface.outputs[0], output.inputs["Surface"])
    return made


def build(scene):
    plate("Table", 0.0, 0.3, 2.4, 2.0, 0.0, wood("Table", (0.030, 0.036, 0.045), (0.065, 0.075, 0.09), 0.4, 6.0))
    inside = smooth_line(((0.0, 0.014), (0.020, 0.0145), (0.0268, 0.022), (0.029, 0.06), (0.0325, 0.122)))
    outside = smooth_line(((0.0342, 0.1225), (0.0315, 0.06), (0.0295, 0.012), (0.0270, 0.001), (0.0, 0.001)))
    # The milk overlaps the glass.
    side = [(r + 0.0006 if r else 0.0, z - 0.0006) for r, z in inside if z < LEVEL - 0.002]
    bodies = (
        lathe("Glass", [*reversed(outside), *reversed(inside)], glass("Glass", (0.985, 1.0, 0.99), 1.5), 160),
        lathe("Milk", [*side, (0.0306, LEVEL + 0.0012), (0.0290, LEVEL), (0.0, LEVEL - 0.0002)], milk(), 128),
    )
    for body in bodies:
        body.data.set_sharp_from_angle(angle=math.radians(35))
    biscuit = varnished("Biscuit", (0.50, 0.26, 0.09), 0.6)
    for k, (x, y, z) in enumerate(((-0.095, 0.02, 0.006), (-0.089, 0.023, 0.0175), (-0.075, -0.055, 0.006))):
        ball(f"Biscuit {k}", (x, y, z), 0.028, biscuit, 32).scale.z = 0.2
    light(
        "SPOT",
        "Lamp",
        (-0.62, -0.55, 0.72),
        (0.02, 0.02, 0.03),
        90.0,
        (1.0, 0.93, 0.82),
        shadow_soft_size=0.006,
        spot_size=math.radians(26),
        spot_blend=0.8,
    )
    color_world(scene, (0.55, 0.68, 0.9), 0.15)
    camera((0.02, -0.34, 0.20), (0.0, 0.0, 0.046), 42.0)
    set_up(scene, 640, 360, bounces=BOUNCES, exposure=0.2)
    set_volume_bounces(scene, rppm=BOUNCES, cycles=BOUNCES)


if __name__ == "__main__":
    save(build)
