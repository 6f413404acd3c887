# SPDX-License-Identifier: GPL-3.0-or-later
"""Short ways to put things into a Blender scene."""

import itertools

import bpy

from rppm_addon.blender.export import export_scene
from rppm_addon.scene import Scene

QUAD = ([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], [(0, 1, 2, 3)])


def add_mesh(scene, name="Mesh", vertices=QUAD[0], faces=QUAD[1], **values):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, [], faces)
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


def add_node(tree, kind, name=None, **inputs):
    """A node; keywords set the inputs of that name, with _ for a space."""
    node = tree.nodes.new(kind)
    if name is not None:
        node.name = name
    for key, value in inputs.items():
        node.inputs[key.replace("_", " ")].default_value = value
    return node


def link(tree, output, target):
    tree.links.new(output, target)


def to_surface(material, node):
    link(material.node_tree, node.outputs[0], material.node_tree.nodes["Output"].inputs["Surface"])


def geometry_nodes(source, *kinds):
    """New nodes of these kinds, one behind the other, between what an object has and what it is shown as."""
    tree = bpy.data.node_groups.new("Geometry", "GeometryNodeTree")
    for way in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=way, socket_type="NodeSocketGeometry")
    nodes = [tree.nodes.new(kind) for kind in ("NodeGroupInput", *kinds, "NodeGroupOutput")]
    for one, other in itertools.pairwise(nodes):
        link(tree, one.outputs[0], other.inputs[0])
    source.modifiers.new("Geometry", "NODES").node_group = tree
    return nodes[1:-1]


def multiply_cubes(source, cubes):
    """An object multiplies cubes beside itself, each given by its place and size."""
    (join,) = geometry_nodes(source, "GeometryNodeJoinGeometry")
    tree = join.id_data
    for place, size in cubes:
        point, cube, multiply = (
            tree.nodes.new(f"GeometryNode{kind}") for kind in ("Points", "MeshCube", "InstanceOnPoints")
        )
        point.inputs["Position"].default_value, cube.inputs["Size"].default_value = place, (size, size, size)
        link(tree, point.outputs[0], multiply.inputs["Points"])
        link(tree, cube.outputs[0], multiply.inputs["Instance"])
        link(tree, multiply.outputs[0], join.inputs[0])


def export(scene) -> Scene:
    scene.view_layers[0].update()
    return export_scene(bpy.context.evaluated_depsgraph_get())


def export_graph(scene, material):
    """The node graph of a material on a quad, and the warnings of the export."""
    quad = add_mesh(scene)
    quad.data.materials.append(material)
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
