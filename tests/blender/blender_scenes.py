# SPDX-License-Identifier: GPL-3.0-or-later
"""Short ways to put things into a Blender scene."""

import contextlib

import bpy
import numpy as np
from node_trees import with_nodes

from rppm_addon.blender.export import export_scene
from rppm_addon.scene import Camera, Scene

CAMERA = Camera(np.eye(4), (-1.0, 1.0, -1.0, 1.0), 8, 8)
QUAD = ([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], [(0, 1, 2, 3)])


def add_mesh(scene, name="Mesh", vertices=QUAD[0], faces=QUAD[1], material=None, **values):
    """An object with a mesh, a quad unless others are given, and a material on all of its faces."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, [], faces)
    if material is not None:
        mesh.materials.append(material)
    return add_object(scene, name, mesh, **values)


def add_object(scene, name, data, **values):
    created = bpy.data.objects.new(name, data)
    for key, value in values.items():
        setattr(created, key, value)
    scene.collection.objects.link(created)
    return created


def add_light(scene, kind, name="Light", **values):
    data = bpy.data.lights.new(name, kind)
    for key, value in values.items():
        setattr(data, key, value)
    return add_object(scene, name, data, location=(0.0, 0.0, 3.0))


def collect(scene, *members, name="Collection"):
    """Move objects of the scene into a new collection that the scene does not show."""
    collection = bpy.data.collections.new(name)
    for member in members:
        scene.collection.objects.unlink(member)
        collection.objects.link(member)
    return collection


def show_collection(scene, collection, name="Empty", **values):
    """An empty that multiplies a collection."""
    return add_object(scene, name, None, instance_type="COLLECTION", instance_collection=collection, **values)


def set_world(scene, color=(0.0, 0.0, 0.0), strength=1.0):
    world = bpy.data.worlds.new("World")
    scene.world = world
    with_nodes(world)
    background = world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (*color, 1.0)
    background.inputs["Strength"].default_value = strength
    return world


def new_image(name, pixels, is_float=False, space=None):
    """An image of pixels (height, width, 4), as Blender stores them."""
    height, width = pixels.shape[:2]
    image = bpy.data.images.new(name, width, height, alpha=True, float_buffer=is_float)
    if space is not None:
        image.colorspace_settings.name = space
    image.pixels.foreach_set(np.ascontiguousarray(pixels, np.float32).ravel())
    return image


def save_png(image, path):
    """Write an image to a file of its own."""
    image.filepath_raw, image.file_format = str(path), "PNG"
    image.save()


def depsgraph():
    """The evaluated depsgraph of the current view layer."""
    return bpy.context.evaluated_depsgraph_get()


@contextlib.contextmanager
def following(call):
    """Call with the depsgraph after each update and change of the frame, as Blender calls a viewport."""

    def follow(_, graph):
        call(graph)

    handlers = (bpy.app.handlers.depsgraph_update_post, bpy.app.handlers.frame_change_post)
    for calls in handlers:
        calls.append(follow)
    try:
        yield
    finally:
        for calls in handlers:
            if follow in calls:  # loading a file removes it
                calls.remove(follow)


def export(scene) -> Scene:
    scene.view_layers[0].update()
    return export_scene(depsgraph())


def export_graph(scene, material):
    """The node graph of a material on a quad, and the warnings of the export."""
    add_mesh(scene, material=material)
    exported = export(scene)
    (instance,) = exported.instances
    return exported.materials[instance.materials[0]].graph, exported.warnings
