# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes pool.blend: waves on a swimming pool in the sun, two seconds, after the paper's Fig. 15 (left).

Run with Python and the bpy module: python pool.py OUT.blend
Geometry nodes move the water: a sum of waves, each with the speed that gravity gives to its length. The sun is as
small as the real one, so a path tracer does not find it from the bottom. Lengths are meters.
"""

import math

import bpy
from sample_scene import add_faces, color_world, material, save, set_up_frames

from mathutils import Vector  # isort: skip

HALF_LENGTH, HALF_WIDTH, DEPTH, DECK = 2.0, 1.4, 1.1, 1.6
LEVEL = -0.12
GRAVITY = 9.81
CELLS_A_METER = 32
WAVES = (
    (1.30, 20.0, 0.00, 0.0110),
    (0.90, -50.0, 0.37, 0.0080),
    (0.62, 75.0, 0.71, 0.0055),
    (0.47, 160.0, 0.13, 0.0036),
    (0.33, -15.0, 0.52, 0.0022),
    (0.25, 110.0, 0.88, 0.0014),
)
"""Length, direction in degrees, phase in turns, height above the level."""


def tiles(name, first, second, size):
    """Square tiles of two colors, by the object's coordinates."""
    made, shader = material(name, "ShaderNodeBsdfDiffuse")
    tree = made.node_tree
    place, checker = tree.nodes.new("ShaderNodeTexCoord"), tree.nodes.new("ShaderNodeTexChecker")
    checker.inputs["Color1"].default_value, checker.inputs["Color2"].default_value = (*first, 1), (*second, 1)
    checker.inputs["Scale"].default_value = 1.0 / size
    shift = tree.nodes.new("ShaderNodeVectorMath")  # faces lie between the tiles' borders, not on them
    shift.inputs[1].default_value = (0.5 * size, 0.5 * size, 0.5 * size)
    tree.links.new(place.outputs["Object"], shift.inputs[0])
    tree.links.new(shift.outputs[0], checker.inputs["Vector"])
    tree.links.new(checker.outputs["Color"], shader.inputs["Color"])
    return made


def build_pool():
    x, y, d, w = HALF_LENGTH, HALF_WIDTH, DEPTH, DECK
    floor = [(-x, -y, -d), (x, -y, -d), (x, y, -d), (-x, y, -d)]
    rim = [(a, b, 0.0) for a, b, _ in floor]
    sides = [(0, 1, 5, 4)[::-1], (1, 2, 6, 5)[::-1], (2, 3, 7, 6)[::-1], (3, 0, 4, 7)[::-1]]
    basin = tiles("Tiles", (0.80, 0.84, 0.84), (0.42, 0.66, 0.74), 0.2)
    add_faces("Basin", floor + rim, [(0, 1, 2, 3), *sides], basin)
    outer = [(a + math.copysign(w, a), b + math.copysign(w, b), 0.0) for a, b, _ in floor]
    stone, _ = material("Stone", "ShaderNodeBsdfDiffuse", Color=(0.58, 0.50, 0.40, 1))
    add_faces("Deck", rim + outer, [(k, k + 4, (k + 1) % 4 + 4, (k + 1) % 4) for k in range(4)], stone)


def build_ball():
    """A ball that lies on the bottom."""
    around, rings, radius = 48, 24, 0.24
    points = [(0, 0, radius)]
    for j in range(1, rings):
        z, across = radius * math.cos(math.pi * j / rings), radius * math.sin(math.pi * j / rings)
        turns = [math.tau * i / around for i in range(around)]
        points += [(across * math.cos(u), across * math.sin(u), z) for u in turns]
    points.append((0, 0, -radius))
    faces, last = [], 1 + (rings - 2) * around
    for i in range(around):
        after = (i + 1) % around
        faces += [(0, 1 + i, 1 + after), (last + i, len(points) - 1, last + after)]
        for j in range(rings - 2):
            here = 1 + j * around
            faces.append((here + i, here + around + i, here + around + after, here + after))
    red, _ = material("Ball", "ShaderNodeBsdfDiffuse", Color=(0.75, 0.09, 0.05, 1))
    ball = add_faces("Ball", points, faces, red)
    ball.data.shade_smooth()
    ball.location = (0.75, 0.35, radius - DEPTH)


def wave_nodes():
    """Geometry nodes that put in a grid whose height is the sum of WAVES at the frame's time."""
    tree = bpy.data.node_groups.new("Waves", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")

    def add(kind, operation=None, *inputs):
        node = tree.nodes.new(kind)
        if operation is not None:
            node.operation = operation
        for socket, value in zip(node.inputs, inputs):
            if isinstance(value, bpy.types.NodeSocket):
                tree.links.new(value, socket)
            else:
                socket.default_value = value
        return node

    # A little wider than the basin: its rim is inside the walls.
    grid = add("GeometryNodeMeshGrid", None, 2 * HALF_LENGTH + 0.02, 2 * HALF_WIDTH + 0.02)
    grid.inputs["Vertices X"].default_value = round(2 * HALF_LENGTH * CELLS_A_METER) + 1
    grid.inputs["Vertices Y"].default_value = round(2 * HALF_WIDTH * CELLS_A_METER) + 1
    place, time = add("GeometryNodeInputPosition"), add("GeometryNodeInputSceneTime")
    height = LEVEL
    for length, degrees, turns, amplitude in WAVES:
        k = math.tau / length
        speed = math.sqrt(GRAVITY * k)  # radians a second, in deep water
        direction = (k * math.cos(math.radians(degrees)), k * math.sin(math.radians(degrees)), 0.0)
        along = add("ShaderNodeVectorMath", "DOT_PRODUCT", place.outputs[0], direction).outputs["Value"]
        since = add("ShaderNodeMath", "MULTIPLY_ADD", time.outputs["Seconds"], -speed, math.tau * turns).outputs[0]
        phase = add("ShaderNodeMath", "ADD", along, since).outputs[0]
        sine = add("ShaderNodeMath", "SINE", phase).outputs[0]
        height = add("ShaderNodeMath", "MULTIPLY_ADD", sine, amplitude, height).outputs[0]
    offset = add("ShaderNodeCombineXYZ", None, 0.0, 0.0, height)
    moved = add("GeometryNodeSetPosition")
    tree.links.new(grid.outputs["Mesh"], moved.inputs["Geometry"])
    tree.links.new(offset.outputs[0], moved.inputs["Offset"])
    smooth = add("GeometryNodeSetShadeSmooth")
    painted = add("GeometryNodeSetMaterial")
    surface, _ = material("Water", "ShaderNodeBsdfGlass", Color=(0.97, 0.99, 1, 1), Roughness=0.0, IOR=1.333)
    painted.inputs["Material"].default_value = surface
    tree.links.new(moved.outputs[0], smooth.inputs["Mesh" if "Mesh" in smooth.inputs else "Geometry"])
    tree.links.new(smooth.outputs[0], painted.inputs["Geometry"])
    end = tree.nodes.new("NodeGroupOutput")
    tree.links.new(painted.outputs[0], end.inputs[0])
    return tree


def build_water():
    data = bpy.data.meshes.new("Water")
    water = bpy.data.objects.new("Water", data)
    bpy.context.collection.objects.link(water)
    water.modifiers.new("Waves", "NODES").node_group = wave_nodes()


def build_light_and_camera(scene):
    data = bpy.data.lights.new("Sun", "SUN")
    data.energy, data.angle, data.color = 4.0, math.radians(0.53), (1.0, 0.96, 0.88)
    sun = bpy.data.objects.new("Sun", data)
    sun.rotation_euler = Vector((-0.35, 0.28, -0.9)).to_track_quat("-Z", "Y").to_euler()
    scene.collection.objects.link(sun)
    data = bpy.data.cameras.new("Camera")
    data.lens = 30.0
    camera = bpy.data.objects.new("Camera", data)
    camera.location = (-1.2, -3.1, 2.7)
    camera.rotation_euler = (Vector((0.15, -0.05, -0.75)) - camera.location).to_track_quat("-Z", "Y").to_euler()
    scene.collection.objects.link(camera)
    scene.camera = camera


def set_up_render(scene):
    set_up_frames(scene, 48)
    color_world(scene, (0.30, 0.48, 0.75), 0.6)
    settings = scene.rppm
    settings.samples, settings.photons, settings.radius_scale = 32, 65536, 12.0
    settings.max_camera_bounces = settings.max_photon_bounces = 4


def build(scene):
    build_pool()
    build_ball()
    build_water()
    build_light_and_camera(scene)
    set_up_render(scene)


if __name__ == "__main__":
    save(build)
