# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that Blender 5 resolves before renderers see them: zones, closures, bundles, menu switches.

test_zones_and_closures.py holds them to their limits.
"""

import bpy

from ...net import Net, material
from .. import stage
from ..lighting.lights import light_with_nodes, lights
from ..lighting.worlds import world
from ..rows import Kind, Row, add, value

GROUP = "Zones, closures, bundles, menus"


def _node(net: Net, kind: str, **inputs: object) -> bpy.types.Node:
    """A node by its whole bl_idname; inputs by name."""
    made = net.tree.nodes.new(kind)
    for name, given in inputs.items():
        net.set(made.inputs[name], given)
    return made


def _pair(net: Net, kind: str) -> tuple[bpy.types.Node, bpy.types.Node]:
    """The nodes at which a zone begins and ends."""
    first, last = _node(net, f"{kind}Input"), _node(net, f"{kind}Output")
    first.pair_with_output(last)
    return first, last


def _fractal(net: Net, iterations: object = 3) -> bpy.types.NodeSocket:
    """Layers of noise, each finer and weaker than the one before: color, scale and number of the round change."""
    first, last = _pair(net, "GeometryNodeRepeat")
    last.repeat_items.new("RGBA", "Sum")
    last.repeat_items.new("FLOAT", "Scale")
    net.set(first.inputs["Iterations"], iterations)
    net.set(first.inputs["Sum"], 0.1)
    net.set(first.inputs["Scale"], 1.3)
    layer = net.out("TexNoise", "Color", {"Scale": first.outputs["Scale"], "Detail": 0.0})
    turn = net.out("Math", 0, {0: first.outputs["Iteration"], 1: 0.5}, operation="ADD")
    weak = net.out("Math", 0, {0: 0.5, 1: turn}, operation="POWER")
    layer = net.out("VectorMath", "Vector", {0: layer, "Scale": weak}, operation="SCALE")
    net.set(last.inputs["Sum"], net.out("VectorMath", 0, {0: first.outputs["Sum"], 1: layer}))
    finer = net.out("Math", 0, {0: first.outputs["Scale"], 1: 2.1}, operation="MULTIPLY")
    net.set(last.inputs["Scale"], finer)
    return last.outputs["Sum"]


def _group(name: str, sockets: dict[str, str]) -> Net:
    """A group of these inputs, by name, and an output Color."""
    tree = bpy.data.node_groups.new(name, "ShaderNodeTree")
    for socket, kind in sockets.items():
        tree.interface.new_socket(socket, in_out="INPUT", socket_type=f"NodeSocket{kind}")
    tree.interface.new_socket("Color", in_out="OUTPUT", socket_type="NodeSocketColor")
    return Net(tree)


def _use(net: Net, group: Net, **inputs: object) -> bpy.types.NodeSocket:
    made = net.tree.nodes.new("ShaderNodeGroup")
    made.node_tree = group.tree
    for name, given in inputs.items():
        net.set(made.inputs[name], given)
    return made.outputs["Color"]


def _add(net: Net, *values: object) -> bpy.types.NodeSocket:
    return net.out("VectorMath", 0, dict(enumerate(values)))


def _zones_of_a_group(net: Net) -> bpy.types.NodeSocket:
    """A group that repeats as often as it is told, and not at all."""
    group = _group("Layers", {"Rounds": "Int"})
    into = _node(group, "NodeGroupInput")
    _node(group, "NodeGroupOutput", Color=_fractal(group, into.outputs["Rounds"]))
    return _add(net, _use(net, group, Rounds=2), _use(net, group, Rounds=0))


def _closure(net: Net) -> bpy.types.NodeSocket:
    """Noise of a scale that is told at its evaluation."""
    first, last = _pair(net, "NodeClosure")
    last.input_items.new("FLOAT", "Scale")
    last.output_items.new("RGBA", "Color")
    noise = net.out("TexNoise", "Color", {"Scale": first.outputs["Scale"], "Detail": 1.0})
    net.set(last.inputs["Color"], noise)
    return last.outputs["Closure"]


def _evaluated(net: Net, closure: bpy.types.NodeSocket, scale: float) -> bpy.types.NodeSocket:
    made = _node(net, "NodeEvaluateClosure")
    made.input_items.new("FLOAT", "Scale")
    made.output_items.new("RGBA", "Color")
    net.tree.links.new(closure, made.inputs["Closure"])
    net.set(made.inputs["Scale"], scale)
    return made.outputs["Color"]


def _closure_twice(net: Net) -> bpy.types.NodeSocket:
    closure = _closure(net)
    return _add(net, _evaluated(net, closure, 2.0), _evaluated(net, closure, 5.0))


PARTS = {"RGBA": "Color", "CLOSURE": "Closure", "FLOAT": "Scale"}


def _bundle(net: Net) -> bpy.types.NodeSocket:
    """A color, a closure and a number that go into a group by one link."""
    combined = _node(net, "NodeCombineBundle")
    for kind, name in PARTS.items():
        combined.bundle_items.new(kind, name)
    net.set(combined.inputs["Color"], net.out("TexVoronoi", "Color", {"Scale": 2.0}))
    net.tree.links.new(_closure(net), combined.inputs["Closure"])
    net.set(combined.inputs["Scale"], 3.0)

    group = _group("Unpacked", {"Bundle": "Bundle"})
    taken = _node(group, "NodeSeparateBundle")
    for kind, name in PARTS.items():
        taken.bundle_items.new(kind, name)
    into = _node(group, "NodeGroupInput")
    group.tree.links.new(into.outputs["Bundle"], taken.inputs["Bundle"])
    color = _evaluated(group, taken.outputs["Closure"], 1.0)
    group.set(color.node.inputs["Scale"], taken.outputs["Scale"])
    _node(group, "NodeGroupOutput", Color=_add(group, taken.outputs["Color"], color))
    made = net.tree.nodes.new("ShaderNodeGroup")
    made.node_tree = group.tree
    net.tree.links.new(combined.outputs["Bundle"], made.inputs["Bundle"])
    return made.outputs["Color"]


def _switch(net: Net, kind: str, menu: object, **items: object) -> bpy.types.NodeSocket:
    made = _node(net, "GeometryNodeMenuSwitch")
    made.data_type = kind
    net.set(made.inputs["Menu"], menu)
    for name, given in items.items():
        net.set(made.inputs[name], given)
    return made.outputs["Output"]


def _menu(net: Net) -> bpy.types.NodeSocket:
    """Switches of two groups whose menus are chosen outside."""
    group = _group("Chosen", {"Choice": "Menu"})
    into = _node(group, "NodeGroupInput")
    noise = group.out("TexNoise", "Color", {"Scale": 3.0})
    color = _switch(group, "RGBA", into.outputs["Choice"], A=noise, B=(0.7, 0.3, 0.1))
    _node(group, "NodeGroupOutput", Color=color)
    return _add(net, _use(net, group, Choice="A"), _use(net, group, Choice="B"))


def _shaders() -> None:
    """A chosen shader, to which each round of a zone adds another."""
    stage.empty()
    surface, net = material()
    stage.set_up(surface)
    first, last = _pair(net, "GeometryNodeRepeat")
    last.repeat_items.new("SHADER", "Sum")
    net.set(first.inputs["Iterations"], 2)
    chosen = net.emission(net.out("TexNoise", "Color", {"Scale": 3.0}))
    net.set(first.inputs["Sum"], _switch(net, "SHADER", "B", A=net.emission((0.0, 1.0, 0.0)), B=chosen))
    layer = net.emission((0.1, 0.2, 0.3), first.outputs["Iteration"])
    net.set(last.inputs["Sum"], net.out("AddShader", 0, {0: first.outputs["Sum"], 1: layer}))
    net.output(last.outputs["Sum"])


def _sky(net: Net) -> tuple[bpy.types.NodeSocket, float]:
    return _fractal(net, 2), 0.8


def _lamp(net: Net) -> tuple[bpy.types.NodeSocket, float]:
    return _switch(net, "RGBA", "B", A=(0.0, 1.0, 0.0), B=net.out("Blackbody", 0, {0: 3200.0})), 1.2


if bpy.app.version >= (5, 0):
    value(GROUP, "repeat zone", _fractal)
    value(GROUP, "repeat zones of a group", _zones_of_a_group)
    value(GROUP, "closure, evaluated twice", _closure_twice)
    value(GROUP, "bundle with a closure, into a group", _bundle)
    value(GROUP, "menu switches", _menu)
    add(Row(GROUP, "repeat zone and menu switch of shaders", _shaders, Kind.VALUES))
    world(GROUP, "repeat zone of a world", _sky)
    lights(GROUP, "menu switch of a light", light_with_nodes("AREA", _lamp, size=0.8))
