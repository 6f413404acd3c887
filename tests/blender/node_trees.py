# SPDX-License-Identifier: GPL-3.0-or-later
"""Short ways to make materials and their nodes, and to read exported graphs."""

import itertools

import bpy


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


def shader_nodes(tree):
    """A new node of each type that Blender's shader editor offers, except outputs and groups."""
    for name in sorted(dir(bpy.types)):
        if name.startswith("ShaderNode") and not name.startswith(("ShaderNodeOutput", "ShaderNodeGroup")):
            try:
                yield tree.nodes.new(name)
            except RuntimeError:
                continue  # a base class
