# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes a drink in a glass as files have it: with a film of air between, at the glass's own faces, or reaching into it.

Run with Python and the bpy module: python drinks.py FOLDER
That writes gap.blend, shared.blend and overlap.blend, which docs/materials.md shows. Lengths are meters.
"""

import itertools
import math
import sys
from pathlib import Path

import bpy

INNER, WALL, BOTTOM, HEIGHT, SURFACE = 0.036, 0.003, 0.01, 0.1, 0.07
"""Inner radius, walls, bottom and height of the glass, and the height at which the drink ends, m."""
WAYS = {"gap": -0.0004, "shared": 0.0, "overlap": 0.0015}
"""Distances by which the drink reaches beyond the glass's inner surface, m."""


def material(name, shader, inputs, absorption=None):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    output, node = tree.nodes.new("ShaderNodeOutputMaterial"), tree.nodes.new(shader)
    for key, value in inputs.items():
        node.inputs[key].default_value = value
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    if absorption is not None:
        volume = tree.nodes.new("ShaderNodeVolumeAbsorption")
        volume.inputs["Color"].default_value, volume.inputs["Density"].default_value = absorption
        tree.links.new(volume.outputs[0], output.inputs["Volume"])
    return made


def lathe(name, profile, surface, columns=96):
    """A solid by its profile (radius, height), from the axis and back to it, counterclockwise."""
    points, rows = [], []
    for radius, z in profile:
        angles = [2 * math.pi * k / columns for k in range(columns if radius else 1)]
        rows.append([len(points) + k for k in range(len(angles))])
        points += [(radius * math.cos(angle), radius * math.sin(angle), z) for angle in angles]
    faces = []
    for low, high in itertools.pairwise(rows):
        for k in range(columns):
            corners = low[k % len(low)], low[(k + 1) % len(low)], high[(k + 1) % len(high)], high[k % len(high)]
            faces.append(list(dict.fromkeys(corners)))
    data = bpy.data.meshes.new(name)
    data.from_pydata(points, [], faces)
    data.materials.append(surface)
    thing = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(thing)


def build(reach):
    """reach: of the drink beyond the glass's inner surface, m."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    glass = material("Glass", "ShaderNodeBsdfGlass", {"Roughness": 0.0, "IOR": 1.5})
    drink = material("Drink", "ShaderNodeBsdfGlass", {"Roughness": 0.0, "IOR": 1.33}, ((0.9, 0.45, 0.1, 1.0), 25.0))
    table = material("Table", "ShaderNodeBsdfDiffuse", {"Color": (0.6, 0.58, 0.55, 1.0)})
    outer = INNER + WALL
    lathe("Tumbler", [(0, 1e-4), (outer, 1e-4), (outer, HEIGHT), (INNER, HEIGHT), (INNER, BOTTOM), (0, BOTTOM)], glass)
    radius, foot = INNER + reach, BOTTOM - reach
    lathe("Drink", [(0, foot), (radius, foot), (radius, SURFACE), (0, SURFACE)], drink)
    bpy.ops.mesh.primitive_plane_add(size=2.0)
    bpy.context.object.data.materials.append(table)
    light = bpy.data.lights.new("Lamp", "AREA")
    light.energy, light.size = 1.5, 0.12
    lamp = bpy.data.objects.new("Lamp", light)
    lamp.location, lamp.rotation_euler = (-0.16, 0.14, 0.3), (-0.45, -0.5, 0.0)
    world = bpy.data.worlds.new("World")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.5
    scene.world = world
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.location, camera.rotation_euler, camera.data.lens = (0.0, -0.42, 0.2), (math.radians(69), 0, 0), 70
    camera.data.clip_start = 0.01
    for thing in (lamp, camera):
        scene.collection.objects.link(thing)
    scene.camera = camera
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 240, 280, 100
    scene.view_settings.view_transform = "Standard"


if __name__ == "__main__":
    for way, reach in WAYS.items():
        build(reach)
        bpy.ops.wm.save_as_mainfile(filepath=str(Path(sys.argv[1]).resolve() / f"{way}.blend"))
