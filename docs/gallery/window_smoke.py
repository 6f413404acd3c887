# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes window_smoke.blend: smoke that rises from a bowl through the sun of a window, which a mirror throws back."""

import math

import bpy
from stage import add_faces, block, camera, color_world, diffuse, lathe, metal, plate, save, set_up, sun, wood
from volumes import scattering, set_volume_bounces

FRAMES = 48
LOW, HIGH = (-0.42, -0.34, 0.42), (0.42, 0.40, 1.42)
"""Corners of the box around the smoke."""
BOWL = 0.42
"""Height of its rim."""
HALF, SILL, TOP, WALL = 0.42, 0.75, 1.75, 1.2
"""Half of the window's width, its lowest and highest edges, and where its wall is."""


def link(tree, kind, inputs, **properties):
    """The first output of a new node; inputs: values or outputs by number."""
    node = tree.nodes.new(f"ShaderNode{kind}")
    for name, value in properties.items():
        setattr(node, name, value)
    for socket, value in inputs.items():
        if isinstance(value, bpy.types.NodeSocket):
            tree.links.new(value, node.inputs[socket])
        else:
            node.inputs[socket].default_value = value
    return node.outputs[0]


def calculate(tree, operation, *values):
    """The result of a Math node."""
    return link(tree, "Math", dict(enumerate(values)), operation=operation)


def smoke():
    """A plume that widens and sways as it rises, torn by noise that moves upward."""
    made = scattering("Smoke", (0.93, 0.95, 1.0), 1.0, 0.45)
    tree = made.node_tree
    place = link(tree, "NewGeometry", {})
    bpy.context.preferences.edit.keyframe_new_interpolation_type = "LINEAR"
    rise = tree.nodes.new("ShaderNodeValue")
    for frame, height in ((1, 0.0), (FRAMES + 1, -0.55)):
        rise.outputs[0].default_value = height
        rise.outputs[0].keyframe_insert("default_value", frame=frame)
    up = link(tree, "CombineXYZ", {2: rise.outputs[0]})
    moving = link(tree, "VectorMath", {0: place, 1: up}, operation="ADD")
    swaying = tree.nodes.new("ShaderNodeTexNoise")
    swaying.inputs["Scale"].default_value, swaying.inputs["Detail"].default_value = 2.6, 1.0
    tree.links.new(moving, swaying.inputs["Vector"])
    aside = link(tree, "VectorMath", {0: swaying.outputs["Color"], 1: (0.5, 0.5, 0.5)}, operation="SUBTRACT")
    parts = tree.nodes.new("ShaderNodeSeparateXYZ")
    tree.links.new(place, parts.inputs[0])
    above = calculate(tree, "SUBTRACT", parts.outputs[2], BOWL)
    sway = calculate(tree, "MULTIPLY", above, 1.3)
    shifted = link(tree, "VectorMath", {0: aside, 3: sway}, operation="SCALE")
    bent = link(tree, "VectorMath", {0: place, 1: shifted}, operation="ADD")
    flat = link(tree, "VectorMath", {0: bent, 1: (1.0, 1.0, 0.0)}, operation="MULTIPLY")
    radius = tree.nodes.new("ShaderNodeVectorMath")
    radius.operation = "LENGTH"
    tree.links.new(flat, radius.inputs[0])
    width = calculate(tree, "MULTIPLY_ADD", above, 0.17, 0.035)
    core = calculate(tree, "SUBTRACT", 1.0, calculate(tree, "DIVIDE", radius.outputs["Value"], width))
    torn = tree.nodes.new("ShaderNodeTexNoise")
    torn.inputs["Scale"].default_value, torn.inputs["Detail"].default_value = 9.0, 3.0
    tree.links.new(link(tree, "VectorMath", {0: moving, 1: shifted}, operation="ADD"), torn.inputs["Vector"])
    wisps = link(tree, "MapRange", {0: torn.outputs[0], 1: 0.38, 2: 0.66, 3: 0.0, 4: 1.0})
    dense = calculate(tree, "MULTIPLY", calculate(tree, "MAXIMUM", core, 0.0), wisps)
    thinning = calculate(tree, "DIVIDE", 11.0, calculate(tree, "MULTIPLY_ADD", above, 0.5, 0.12))
    density = calculate(tree, "MULTIPLY", dense, thinning)
    volume = next(node for node in tree.nodes if node.type == "VOLUME_SCATTER")
    tree.links.new(density, volume.inputs["Density"])
    return made


def room():
    """Walls, of which the right one has a window with bars."""
    wall, frame = diffuse("Wall", (0.28, 0.25, 0.22)), diffuse("Frame", (0.12, 0.07, 0.04))
    block("Back", (-2.2, 1.3, 0.0), (WALL, 1.4, 2.6), wall)
    for number, (low, high) in enumerate(
        (
            ((WALL, -2.0, 0.0), (WALL + 0.1, 1.4, SILL)),
            ((WALL, -2.0, TOP), (WALL + 0.1, 1.4, 2.6)),
            ((WALL, -2.0, SILL), (WALL + 0.1, -HALF, TOP)),
            ((WALL, HALF, SILL), (WALL + 0.1, 1.4, TOP)),
        )
    ):
        block(f"Right {number}", low, high, wall)
    block("Ceiling", (-2.2, -2.0, 2.6), (WALL + 0.1, 1.4, 2.7), wall)
    block("Post", (WALL + 0.03, -0.02, SILL), (WALL + 0.07, 0.02, TOP), frame)
    for height in (SILL + 0.33, SILL + 0.66):
        block("Bar", (WALL + 0.03, -HALF, height - 0.015), (WALL + 0.07, HALF, height + 0.015), frame)


def build(scene):
    plate("Floor", -0.5, 0.0, 3.6, 4.0, 0.0, diffuse("Floor", (0.16, 0.11, 0.08)))
    room()
    oak = wood("Oak", (0.10, 0.055, 0.03), (0.22, 0.14, 0.08), 0.4, 24.0, 2.5)
    block("Table", (-0.75, -0.5, 0.32), (0.65, 0.5, 0.36), oak, 0.004)
    bowl = ((0.0, 0.0), (0.035, 0.0), (0.062, 0.052), (0.056, 0.055), (0.030, 0.010), (0.0, 0.010))
    lathe("Bowl", bowl, metal("Bronze", (0.55, 0.36, 0.18), 0.2), 96).location.z = 0.362
    # A mirror leans on the left, and throws the sun back through the smoke.
    mirror = add_faces(
        "Mirror",
        [(0.0, -0.11, -0.13), (0.0, 0.11, -0.13), (0.0, 0.11, 0.13), (0.0, -0.11, 0.13)],
        [(0, 1, 2, 3)],
        metal("Silver", (0.95, 0.95, 0.95), 0.0),
    )
    mirror.location, mirror.rotation_euler = (-0.58, 0.05, 0.50), (0.0, math.radians(-40), math.radians(2))
    block("Smoke", LOW, HIGH, smoke())
    sun((-0.80, 0.03, -0.46), 9.0, (1.0, 0.87, 0.70))
    color_world(scene, (0.45, 0.62, 1.0), 0.35)
    camera((-0.35, -1.85, 0.98), (0.02, 0.0, 0.80), 38.0)
    set_up(scene, 640, 360, exposure=0.9)
    scene.render.fps, scene.frame_start, scene.frame_end = 24, 1, FRAMES
    set_volume_bounces(scene, rppm=1, cycles=1)


if __name__ == "__main__":
    save(build)
