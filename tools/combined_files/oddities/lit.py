# SPDX-License-Identifier: GPL-3.0-or-later
"""Lamps with odd settings, and worlds."""

import bpy

from .. import images
from ..draws import Draws
from ..graphs import Graph, finish, material
from ..scenes import Place, add, cylinder, lamp, shape, world
from .parts import matte, part


def _target(draws: Draws, at: Place) -> None:
    add("Target", shape("icosphere", matte(draws.color(0.9)), radius=0.2), (at[0], at[1], 0.21))


@part
def odd_lamp(draws: Draws, at: Place) -> None:
    """A lamp with a temperature, an exposure, a negative color, no shadow, a spread or a texture."""
    _target(draws, at)
    kind = draws.pick(("POINT", "SPOT", "AREA"))
    made = lamp(kind, (at[0], at[1] - 0.3, 0.9), draws.between(5, 15), (at[0], at[1], 0.2))
    data = made.data
    choice = draws.pick(("temperature", "exposure", "no_shadow", "texture", "normalize", "hard", "falloff", "scaled"))
    if choice == "temperature":
        data.use_temperature, data.temperature = True, draws.between(2000, 9000)
    elif choice == "exposure":
        data.exposure = draws.between(-1, 1)
    elif choice == "no_shadow":
        data.use_shadow = False
    elif choice == "normalize":
        data.normalize = False
        data.energy = 1.0
    elif choice == "scaled":
        made.scale = (2.0, 0.5, 1.0)
    elif choice in {"texture", "falloff"}:
        data.use_nodes = True
        graph = Graph(data.node_tree)
        emission = data.node_tree.nodes["Emission"]
        if choice == "texture":
            coordinates = graph.node("TexCoord").outputs["Normal"]
            checker = graph.node("TexChecker", None, {0: coordinates, 1: draws.color(), 2: draws.color(), 3: 8.0})
            graph.tree.links.new(checker.outputs[0], emission.inputs["Color"])
        else:
            node = graph.node("LightFalloff", Strength=2.0, Smooth=draws.pick((0.0, 0.5)))
            graph.tree.links.new(node.outputs[draws.pick((0, 1, 2))], emission.inputs["Strength"])
    if kind == "SPOT":
        data.spot_size, data.spot_blend = draws.between(0.5, 2.0), draws.pick((0.0, 0.3, 1.0))
        data.shadow_soft_size = draws.pick((0.0, 0.1))
    elif kind == "AREA":
        data.shape = draws.pick(("SQUARE", "RECTANGLE", "DISK", "ELLIPSE"))
        data.size, data.size_y, data.spread = 0.3, 0.15, draws.pick((3.14, 1.0, 0.2))
    else:
        data.shadow_soft_size = draws.pick((0.0, 0.1))
        data.use_soft_falloff = draws.maybe()
    if choice == "hard" and kind != "AREA":
        data.shadow_soft_size = 0.0


@part
def linked_lamp(draws: Draws, at: Place) -> None:
    """A lamp that shines on some objects only, and from which others cast no shadow."""
    _target(draws, at)
    other = add("Other", cylinder(matte(draws.color(0.9)), 0.1, 0.5), (at[0] + 0.3, at[1] - 0.1, 0.26))
    made = lamp("AREA", (at[0], at[1] - 0.4, 1.0), 10.0, (at[0], at[1], 0.2), size=0.2)
    held = bpy.data.collections.new("Linked")
    held.objects.link(other)
    if draws.maybe():
        made.light_linking.receiver_collection = held
    else:
        made.light_linking.blocker_collection = held
    state = draws.pick(("INCLUDE", "EXCLUDE"))
    held.collection_objects[0].light_linking.link_state = state


@part
def glowing_card(draws: Draws, at: Place) -> None:
    """A screen that emits a picture forward only, invisible to some rays."""
    made, graph = material("Screen")
    picture = graph.node("TexImage", {"image": images.image("Screen", images.colored(draws), False)})
    facing = graph.node("NewGeometry").outputs["Backfacing"]
    lit = graph.node("Emission", Color=picture, Strength=draws.between(1, 3))
    finish(graph, graph.node("MixShader", None, {0: facing, 1: lit, 2: graph.node("BsdfDiffuse")}))
    card = add("Screen", shape("grid", made), (at[0], at[1] + 0.2, 0.45), (1.4, 0, 0.3), (0.8, 0.6, 1))
    setattr(card, draws.pick(("visible_camera", "visible_glossy", "visible_diffuse", "visible_shadow")), False)
    _target(draws, at)


@part
def caught(draws: Draws, at: Place) -> None:
    """Light that lamps give to some kinds of rays only."""
    _target(draws, at)
    made = lamp("SPOT", (at[0] + 0.2, at[1] - 0.4, 1.0), 20.0, (at[0], at[1], 0.2), spot_size=0.9)
    setattr(made, draws.pick(("visible_diffuse", "visible_glossy", "visible_camera")), False)
    made.data.diffuse_factor, made.data.specular_factor = 1.0, 1.0


def odd_world(draws: Draws) -> str:
    """A world of a kind that is seldom met; says which."""
    choice = draws.pick(
        ("sky", "split", "mirror_ball", "gradient", "window", "none", "hidden", "volume", "nishita_sun")
    )
    tree = world(draws.color(0.4, (0.3, 0.8)), draws.between(0.5, 1.2))
    graph, background = Graph(tree), tree.nodes["Background"]
    if choice == "none":
        bpy.context.scene.world = None
    elif choice in {"sky", "nishita_sun"}:
        settings = {"sky_type": draws.pick(("MULTIPLE_SCATTERING", "SINGLE_SCATTERING", "PREETHAM", "HOSEK_WILKIE")),
                    "sun_elevation": draws.between(0.1, 1.2), "sun_disc": choice == "nishita_sun"}  # fmt: skip
        tree.links.new(graph.node("TexSky", settings).outputs[0], background.inputs["Color"])
        background.inputs["Strength"].default_value = 0.1 if "SCATTERING" in settings["sky_type"] else 0.5
    elif choice == "split":
        seen = graph.node("LightPath").outputs["Is Camera Ray"]
        behind = graph.node("Background", Color=draws.color(0.9), Strength=0.3)
        mix = graph.node("MixShader", None, {0: seen, 1: background, 2: behind})
        tree.links.new(mix.outputs[0], tree.nodes["World Output"].inputs["Surface"])
    elif choice == "mirror_ball":
        settings = {"image": images.image("Ball", images.sky(draws)), "projection": "MIRROR_BALL"}
        tree.links.new(graph.node("TexEnvironment", settings).outputs[0], background.inputs["Color"])
    elif choice in {"gradient", "window"}:
        name = "Window" if choice == "window" else draws.pick(("Generated", "Normal", "Object", "Reflection"))
        split = graph.node("SeparateXYZ", None, {0: graph.node("TexCoord").outputs[name]})
        ramp = graph.ramp(split.outputs[1 if name == "Window" else 2], [(0.0, draws.color()), (0.7, draws.color())])
        tree.links.new(ramp.outputs[0], background.inputs["Color"])
    elif choice == "hidden":
        visible = bpy.context.scene.world.cycles_visibility
        setattr(visible, draws.pick(("camera", "diffuse", "glossy", "scatter")), False)
    elif choice == "volume":
        fog = graph.node("VolumeScatter", Color=(0.8, 0.9, 1.0, 1), Density=0.03)
        tree.links.new(fog.outputs[0], tree.nodes["World Output"].inputs["Volume"])
    if bpy.context.scene.world is not None:
        mist = bpy.context.scene.world.mist_settings
        mist.use_mist, mist.start, mist.depth = True, 1.0, 10.0
    return choice
