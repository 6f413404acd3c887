# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials with many nodes, on balls, cubes and monkeys in a row."""

import bpy

from . import materials
from .draws import Draws
from .graphs import Graph, finish, geometry_nodes, material
from .products import backdrop, studio
from .rooms import sky
from .scenes import add, camera, cylinder, kind, modifier, shape, world


def _grouped(draws: Draws) -> bpy.types.Material:
    """A node group with inputs of its own, used twice, inside another."""
    inner = bpy.data.node_groups.new("Inner", "ShaderNodeTree")
    inner.interface.new_socket("Scale", in_out="INPUT", socket_type="NodeSocketFloat").default_value = 3.0
    inner.interface.new_socket("Tint", in_out="INPUT", socket_type="NodeSocketColor").default_value = draws.color()
    inner.interface.new_socket("Color", in_out="OUTPUT", socket_type="NodeSocketColor")
    inner.interface.new_socket("Height", in_out="OUTPUT", socket_type="NodeSocketFloat")
    graph = Graph(inner)
    given, output = inner.nodes.new("NodeGroupInput"), inner.nodes.new("NodeGroupOutput")
    vector = graph.node("TexCoord").outputs[draws.pick(("Generated", "UV", "Object"))]
    noise = graph.node("TexNoise", Scale=given.outputs["Scale"], Vector=vector)
    color = graph.mixed(noise, given.outputs["Tint"], draws.color(), draws.pick(("MIX", "MULTIPLY", "SCREEN")))
    inner.links.new(color, output.inputs["Color"])
    inner.links.new(noise.outputs[0], output.inputs["Height"])
    made, graph = material("Grouped")
    first = graph.node("Group", {"node_tree": inner}, Scale=draws.between(1, 8))
    second = graph.node("Group", {"node_tree": inner}, Tint=draws.color())
    color = graph.mixed(first.outputs[1], first.outputs[0], second.outputs[0])
    bump = graph.node("Bump", Height=second.outputs[1], Strength=0.3, Distance=0.1)
    finish(graph, graph.node("BsdfPrincipled", Base_Color=color, Roughness=first.outputs[1], Normal=bump))
    return made


def _driven(draws: Draws) -> bpy.types.Material:
    """A value that a driver computes."""
    made, graph = material("Driven")
    value = graph.node("Value")
    driver = value.outputs[0].driver_add("default_value").driver
    driver.type, driver.expression = "SCRIPTED", f"0.1 * frame + {draws.between(0, 0.5):.3f}"
    hue = graph.node("HueSaturation", Color=draws.color(0.9), Hue=value)
    finish(graph, graph.node("BsdfPrincipled", Base_Color=hue, Roughness=graph.math("MULTIPLY", value, 0.8)))
    return made


def _attributed(draws: Draws, thing: bpy.types.Object) -> None:
    """An attribute that geometry nodes store, which the material shows."""
    graph, given, output = geometry_nodes(thing)
    noise = graph.tree.nodes.new("ShaderNodeTexNoise")
    noise.inputs["Scale"].default_value = draws.between(1, 5)
    settings = {"data_type": "FLOAT_COLOR", "domain": draws.pick(("POINT", "CORNER", "FACE"))}
    store = graph.node("StoreNamedAttribute", settings, {0: given}, Name="Cells")
    graph.tree.links.new(noise.outputs["Color"], store.inputs["Value"])
    graph.tree.links.new(store.outputs[0], output.inputs[0])
    made, shader = material("Attributed")
    cells = shader.node("Attribute", {"attribute_name": "Cells"})
    finish(shader, shader.node("BsdfPrincipled", Base_Color=cells, Roughness=cells.outputs["Fac"]))
    thing.data.materials[0] = made


def _displaced(draws: Draws) -> bpy.types.Material:
    made, graph = material("Displaced")
    color, pattern = materials.layered_color(draws, graph)
    height = graph.node("Displacement", Height=pattern, Midlevel=0.5, Scale=draws.between(0.02, 0.08))
    finish(graph, graph.node("BsdfPrincipled", Base_Color=color, Roughness=0.5), displacement=height)
    made.displacement_method = draws.pick(("BUMP", "DISPLACEMENT", "BOTH"))
    return made


@kind
def nodes(draws: Draws) -> None:
    """Twelve things with a material each, whose colors come of chained nodes."""
    backdrop(materials.procedural(draws))
    forms = ("uvsphere", "cube", "monkey", "cone", "icosphere")
    makers = (materials.procedural, materials.procedural, materials.mixed, materials.mixed, _grouped, _driven,
              materials.textured, _displaced, materials.lacquer)  # fmt: skip
    for at in range(12):
        form = draws.pick(forms)
        place = (0.62 * (at % 4 - 1.5), 0.8 * (at // 4), 0.28 + 0.4 * (at // 4))
        smooth = form != "cube"
        thing = add(form.title(), shape(form, draws.pick(makers)(draws), smooth), place, (0, 0, draws.between(-1, 1)))
        size = 0.2 if form == "monkey" else 0.45
        thing.scale = (size, size * draws.pick((1.0, 1.0, 1.2)), size)
        if form == "cube":
            modifier(thing, "BEVEL", width=0.05, segments=3)
        elif draws.maybe(0.3):
            modifier(thing, "SUBSURF", levels=1, render_levels=1)
        if draws.maybe(0.2):
            _attributed(draws, thing)
        if at // 4:
            add("Stand", cylinder(None, 0.08, place[2] - 0.27), (place[0], place[1], (place[2] - 0.27) / 2 + 0.004))
    if draws.maybe():
        sky(draws)
    else:
        world(draws.color(0.3, (0.2, 0.6)))
    studio(draws)
    camera((0, -3.3, 1.7), (0, 0.5, 0.5), 45.0)
