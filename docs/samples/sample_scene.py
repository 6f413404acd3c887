# SPDX-License-Identifier: GPL-3.0-or-later
"""What the scripts that make the samples do alike."""

import math
import sys
from pathlib import Path

import bpy

import rppm_addon


def material(name, shader, **inputs):
    """A material of one shader node with constant values; returns it and the node."""
    made = bpy.data.materials.new(name)
    if bpy.app.version < (5, 0):
        made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    node = tree.nodes.new(shader)
    for key, value in inputs.items():
        node.inputs[key.replace("_", " ")].default_value = value
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    output.location.x = 300
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    return made, node


def add_faces(name, points, faces, surface):
    """An object of a mesh that is given by its points and faces."""
    data = bpy.data.meshes.new(name)
    data.from_pydata(points, [], faces)
    data.materials.append(surface)
    made = bpy.data.objects.new(name, data)
    bpy.context.collection.objects.link(made)
    return made


def surface_of_revolution(name, profile, surface, around=96):
    """Round the Z axis, smooth; profile: closed, (radius, height) each; points on the axis are radius 0."""
    rings = [
        [(radius * math.cos(u), radius * math.sin(u), height) for u in (math.tau * i / around for i in range(around))]
        if radius
        else [(0.0, 0.0, height)]
        for radius, height in profile
    ]
    points, starts = [], []
    for ring in rings:
        starts.append(len(points))
        points += ring
    faces = []
    for k in range(len(rings)):
        low, high = k, (k + 1) % len(rings)
        if len(rings[low]) == len(rings[high]) == 1:
            continue
        for i in range(around):
            corners = []
            for ring, order in ((low, (i, i + 1)), (high, (i + 1, i))):
                corners += [starts[ring] + (0 if len(rings[ring]) == 1 else j % around) for j in order]
            faces.append(tuple(dict.fromkeys(corners)))
    made = add_faces(name, points, faces, surface)
    made.data.shade_smooth()
    return made


def color_world(scene, color, strength):
    """A world of one color."""
    scene.world = bpy.data.worlds.new("World")
    if bpy.app.version < (5, 0):
        scene.world.use_nodes = True
    background = scene.world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (*color, 1)
    background.inputs["Strength"].default_value = strength


def set_up_pictures(scene):
    """Of 480 x 360 pixels, with RPPM."""
    render = scene.render
    render.resolution_x, render.resolution_y, render.resolution_percentage = 480, 360, 100
    scene.view_settings.view_transform = "AgX"
    render.engine = "RPPM"


def set_up_frames(scene, last):
    """An animation of such pictures, 24 a second."""
    set_up_pictures(scene)
    scene.render.fps, scene.frame_start, scene.frame_end = 24, 1, last


def save(build):
    """Build in an empty scene, which ``build`` is given, and save it where the command line says."""
    rppm_addon.register()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    build(bpy.context.scene)
    bpy.context.preferences.filepaths.save_version = 0  # no .blend1 beside it
    bpy.ops.wm.save_as_mainfile(filepath=str(Path(sys.argv[-1]).resolve()), compress=True)
    rppm_addon.unregister()
