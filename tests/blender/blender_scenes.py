# SPDX-License-Identifier: GPL-3.0-or-later
"""Short ways to put things into a Blender scene."""

import contextlib
import itertools

import bpy
import numpy as np

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


def new_material(name="Material"):
    """A material with a Material Output node and nothing else."""
    material = bpy.data.materials.new(name)
    with_nodes(material)
    material.node_tree.nodes.clear()
    output = material.node_tree.nodes.new("ShaderNodeOutputMaterial")
    output.name = "Output"
    return material


def with_nodes(owner):
    if bpy.app.version < (5, 0):
        owner.use_nodes = True


def add_node(tree, kind, name=None, **given):
    """A node, named if a name is given.

    Keywords set its inputs by their names, with _ for a space: to a value, or linked to a socket; keywords in lower
    case set its properties. Blender hides inputs by the properties, which are therefore given first.
    """
    node = tree.nodes.new(kind)
    if name is not None:
        node.name = name
    for key, value in given.items():
        if key[0].islower():
            setattr(node, key, value)
        elif isinstance(value, bpy.types.NodeSocket):
            link(tree, value, node.inputs[key.replace("_", " ")])
        else:
            node.inputs[key.replace("_", " ")].default_value = value
    return node


def constant(tree, value, kind="ShaderNodeValue"):
    """The output of a new node that gives a number; of ShaderNodeRGB, a color."""
    output = tree.nodes.new(kind).outputs[0]
    output.default_value = value
    return output


def link(tree, output, target):
    tree.links.new(output, target)


def to_surface(material, node):
    link(material.node_tree, node.outputs[0], material.node_tree.nodes["Output"].inputs["Surface"])


def surface(kind, name=None, material=None, **given):
    """A material, new unless one is given, whose surface is a new node, and this node."""
    material = material or new_material()
    node = add_node(material.node_tree, kind, name, **given)
    to_surface(material, node)
    return material, node


def mixed(tree, factor, first, second):
    """A Mix Shader node of the first outputs of two nodes."""
    mix = add_node(tree, "ShaderNodeMixShader")
    mix.inputs[0].default_value = factor
    for shader, socket in zip((first, second), mix.inputs[1:], strict=True):
        link(tree, shader.outputs[0], socket)
    return mix


def added(tree, first, second):
    """An Add Shader node of the first outputs of two nodes."""
    add = add_node(tree, "ShaderNodeAddShader")
    for shader, socket in zip((first, second), add.inputs, strict=True):
        link(tree, shader.outputs[0], socket)
    return add


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


def node_group(inputs=(), outputs=(), tree_type="ShaderNodeTree"):
    """A node group with sockets, each given by its name and type, and its input and output nodes."""
    group = bpy.data.node_groups.new("Group", tree_type)
    for way, sockets in (("INPUT", inputs), ("OUTPUT", outputs)):
        for name, kind in sockets:
            group.interface.new_socket(name, in_out=way, socket_type=f"NodeSocket{kind}")
    return group, group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")


def geometry_nodes(source, *kinds):
    """New nodes of these kinds, one behind the other, between what an object has and what it is shown as."""
    tree, first, last = node_group([("Geometry", "Geometry")], [("Geometry", "Geometry")], "GeometryNodeTree")
    nodes = [first, *(tree.nodes.new(kind) for kind in kinds), last]
    for one, other in itertools.pairwise(nodes):
        link(tree, one.outputs[0], other.inputs[0])
    source.modifiers.new("Geometry", "NODES").node_group = tree
    return nodes[1:-1]


def multiply_cubes(source, cubes):
    """An object multiplies cubes beside itself, each given by its place and size."""
    (join,) = geometry_nodes(source, "GeometryNodeJoinGeometry")
    tree = join.id_data
    for place, size in cubes:
        point = add_node(tree, "GeometryNodePoints", Position=place)
        cube = add_node(tree, "GeometryNodeMeshCube", Size=(size, size, size))
        multiply = add_node(tree, "GeometryNodeInstanceOnPoints", Points=point.outputs[0], Instance=cube.outputs[0])
        link(tree, multiply.outputs[0], join.inputs[0])


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


def shaders(graph):
    """(node, weight) of the shaders that a graph adds up; factors of its mixes must be constants."""
    found = []

    def add(shader, weight):
        if shader is None or weight == 0.0:
            return
        node = graph.nodes[shader.node]
        first, second = node.inputs.get("shader"), node.inputs.get("shader_001")
        if node.kind == "mix_shader":
            add(first, weight * (1.0 - node.inputs["fac"]))
            add(second, weight * node.inputs["fac"])
        elif node.kind == "add_shader":
            add(first, weight)
            add(second, weight)
        else:
            found.append((node, weight))

    add(graph.surface, 1.0)
    return found


def source(graph, node, name):
    """The node that feeds an input."""
    return graph.nodes[node.inputs[name].node]
