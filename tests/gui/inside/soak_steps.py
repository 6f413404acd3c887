# SPDX-License-Identifier: GPL-3.0-or-later
"""Steps of ../window_soak.py, which repeats them on a file: a few states of the scene that come again in turn."""

import array

import bpy
from viewport_steps import paint
from window_steps import window

STATES = 8
FRAMES = 10
"""Frames of the animation, which is the same in each state but for what the state changes."""
SIZES = ((96, 64), (64, 96), (80, 80), (96, 64))
COLORS = ((0.8, 0.8, 0.8), (0.8, 0.2, 0.1), (0.1, 0.6, 0.2), (0.1, 0.2, 0.8))
_kept: dict[str, object] = {}


def soak_begin() -> None:
    """Lossless pictures of few samples, an object that moves, and one whose mesh and image are made anew each time."""
    scene = window().scene
    render = scene.render
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
    render.image_settings.exr_codec, render.filepath = "ZIP", "/mnt/soak/####"
    scene.frame_start, scene.frame_end = 1, FRAMES
    scene.rppm.samples, scene.rppm.photons = 2, 1024
    scene.rppm.preview_samples, scene.rppm.preview_photons = 4, 4096
    band = bpy.data.objects["Gold Band"]
    for frame in range(1, FRAMES + 1):
        band.location.z += 0.02
        band.keyframe_insert("location", frame=frame)
    material = bpy.data.materials.new("Soak")
    if bpy.app.version < (5, 0):
        material.use_nodes = True
    tree = material.node_tree
    texture = tree.nodes.new("ShaderNodeTexImage")
    tree.links.new(texture.outputs["Color"], tree.nodes["Principled BSDF"].inputs["Base Color"])
    thing = bpy.data.objects.new("Soak", _mesh(0))
    thing.data.materials.append(material)
    thing.location = (-0.1, -1.1, 0.05)
    scene.collection.objects.link(thing)
    _kept.update(crystal=bpy.data.objects["Crystal"].location.copy(), watts=bpy.data.lights["Lamp"].energy)


def soak_state(state: int) -> int:
    """Put the scene into one of the states; returns the frame that it is at."""
    scene = window().scene
    crystal = bpy.data.objects["Crystal"]
    crystal.location = _kept["crystal"]
    crystal.location.x -= 0.05 * state
    crystal.hide_viewport = crystal.hide_render = state == 5
    bpy.data.lights["Lamp"].energy = _kept["watts"] * (1.0 + 0.1 * state)
    paint("Floor", [*COLORS[state % 4], 1.0])
    scene.render.resolution_x, scene.render.resolution_y = SIZES[state % 4]
    scene.frame_set(1 + state % FRAMES)
    thing = bpy.data.objects["Soak"]
    before, slot = thing.data, thing.data.materials[0]
    thing.data = _mesh(state)
    thing.data.materials.append(slot)
    bpy.data.meshes.remove(before)
    node = next(node for node in slot.node_tree.nodes if node.type == "TEX_IMAGE")
    image, node.image = node.image, _image(state)
    if image is not None:
        bpy.data.images.remove(image)
    return scene.frame_current


def soak_copy(path: str) -> None:
    """Save the file as it is now for another Blender."""
    bpy.ops.wm.save_as_mainfile(filepath=path, copy=True)


def _mesh(state: int) -> bpy.types.Mesh:
    """A wavy strip, the finer the higher the state."""
    count = 8 + 9 * state
    vertices = [(x / count, y, 0.1 * (x % 2)) for x in range(count + 1) for y in (0.0, 0.5)]
    mesh = bpy.data.meshes.new("Soak")
    mesh.from_pydata(vertices, [], [(2 * x, 2 * x + 2, 2 * x + 3, 2 * x + 1) for x in range(count)])
    layer = mesh.uv_layers.new(name="UVMap")
    for loop, corner in zip(layer.data, mesh.loops):
        loop.uv = vertices[corner.vertex_index][:2]
    return mesh


def _image(state: int) -> bpy.types.Image:
    size = 32 * (1 + state % 3)
    image = bpy.data.images.new("Soak", size, size)
    values = [((x * (state + 3)) % 17) / 16.0 for x in range(size * size)]
    image.pixels.foreach_set(array.array("f", (part for value in values for part in (value, 1.0 - value, 0.5, 1.0))))
    image.pack()
    return image
