# SPDX-License-Identifier: GPL-3.0-or-later
"""Rooms as people render them for architects: windows, furniture, shaded lamps, rugs."""

import math

import bpy

from . import images, materials
from .draws import Draws
from .graphs import Graph, finish, material
from .scenes import add, camera, collection, curve, cylinder, instance, kind, lamp, modifier, shape, world

IES = "IESNA:LM-63-2002\nTILT=NONE\n1 1000 1 7 1 1 2 0 0 0\n1 1 100\n0 15 30 45 60 75 90\n0\n900 850 700 450 200 60 0\n"
"""Photometric data of a lamp that shines down."""


def _walls(draws: Draws, width: float, depth: float, height: float) -> None:
    """A box of thick walls with an opening on the left, which has a frame and often a pane."""
    paint = materials.plain(draws)
    sides = [
        ((0, depth / 2 + 0.1, height / 2), (width + 0.4, 0.2, height)),
        ((width / 2 + 0.1, 0, height / 2), (0.2, depth, height)),
        ((0, 0, height + 0.1), (width + 0.4, depth + 0.4, 0.2)),
        ((-width / 2 - 0.1, 0, 0.4), (0.2, depth, 0.8)),
        ((-width / 2 - 0.1, 0, height - 0.2), (0.2, depth, 0.4)),
        ((-width / 2 - 0.1, depth / 2 - 0.4, height / 2 + 0.2), (0.19, 0.79, height - 1.2)),
    ]
    wall = shape("cube", paint)
    for at, scale in sides:
        add("Wall", wall, at, scale=scale)
    floor = add("Floor", shape("grid", materials.textured(draws, 4.0)), scale=(width + 0.4, depth + 3.0, 1))
    floor.location.z = 0.001
    if draws.maybe(0.7):
        pane = materials.pane(draws) if draws.maybe(0.7) else materials.glass(draws, 0.0)
        thing = add(
            "Pane", shape("grid" if draws.maybe() else "cube", pane), (-width / 2 - 0.1, -0.4, height / 2 + 0.2)
        )
        thing.scale = (depth - 0.9, height - 1.3, 0.02)
        thing.rotation_euler = (math.pi / 2, 0, math.pi / 2)
    frame = shape("cube", materials.plain(draws))
    for at in range(3):
        add("Frame", frame, (-width / 2 - 0.02, -depth / 2 + 0.7 * (at + 1), height / 2 + 0.2), scale=(0.05, 0.05, 1.2))


def _chair(draws: Draws, legs: bpy.types.Mesh, seat: bpy.types.Mesh) -> bpy.types.Collection:
    parts = [add("Leg", legs, (0.2 * x, 0.2 * y, 0.22)) for x in (-1, 1) for y in (-1, 1)]
    parts += [add("Seat", seat, (0, 0, 0.47), scale=(0.5, 0.5, 0.06))]
    parts += [add("Back", seat, (0, 0.23, 0.75), rotation=(-0.1, 0, 0), scale=(0.48, 0.04, 0.4))]
    if draws.maybe():
        modifier(parts[-1], "BEVEL", width=0.01, segments=2)
    return collection("Chair", parts)


def _lamp(draws: Draws, at: tuple[float, float, float]) -> None:
    """A bulb in an open shade, on a stand."""
    shade = draws.pick(("translucent", "plain", "mixed"))
    paint = materials.plain(draws) if shade == "plain" else _fabric(draws)
    add("Shade", shape("cone", paint, True, radius1=0.22, radius2=0.14, depth=0.3, cap_ends=False), at)
    x, y, z = at
    add("Stand", cylinder(materials.metal(draws), 0.02, z - 0.1), (x, y, (z - 0.1) / 2 + 0.005))
    if draws.maybe(0.6):
        lamp("POINT", at, draws.between(10, 40), shadow_soft_size=draws.between(0.03, 0.08), color=(1.0, 0.8, 0.55))
    else:
        add("Bulb", shape("uvsphere", materials.glow(draws, draws.between(20, 60)), True, radius=0.05), at)


def _fabric(draws: Draws) -> bpy.types.Material:
    made, graph = material("Fabric")
    color = draws.color(0.3, (0.6, 0.9))
    halves = {0: 0.5, 1: graph.node("BsdfDiffuse", Color=color), 2: graph.node("BsdfTranslucent", Color=color)}
    finish(graph, graph.node("MixShader", None, halves))
    return made


def _rug(draws: Draws, at: tuple[float, float, float]) -> None:
    rug = add("Rug", shape("grid", materials.plain(draws), x_segments=4, y_segments=4), at, scale=(1.4, 1.0, 1))
    if not draws.maybe(0.6):
        return
    settings = modifier(rug, "PARTICLE_SYSTEM").particle_system.settings
    settings.type, settings.count, settings.hair_length = "HAIR", draws.randint(200, 600), draws.between(0.03, 0.08)
    settings.root_radius, settings.tip_radius = 1.0, draws.pick((0.0, 0.5))
    settings.radius_scale = 0.008
    if draws.maybe():
        settings.child_type = draws.pick(("SIMPLE", "INTERPOLATED"))
        settings.rendered_child_count = 5
        settings.roughness_1 = 0.02


def _downlights(draws: Draws, width: float, height: float) -> None:
    for at in range(draws.randint(1, 3)):
        place = (width * (at - 1) / 3.5, draws.between(-0.5, 0.8), height - 0.15)
        spot = lamp("SPOT" if draws.maybe() else "POINT", place, draws.between(15, 50), shadow_soft_size=0.05)
        if draws.maybe(0.6):
            spot.data.use_nodes = True
            graph = Graph(spot.data.node_tree)
            text = bpy.data.texts.new("Light.ies")
            text.write(IES)
            node = graph.node("TexIES", {"mode": "INTERNAL", "ies": text}, Strength=draws.between(0.5, 1.5))
            graph.tree.links.new(node.outputs[0], graph.tree.nodes["Emission"].inputs["Strength"])


@kind
def room(draws: Draws) -> None:
    """A room with a window, a table, chairs that are instances, a rug and lamps."""
    width, depth, height = draws.between(3.5, 5.0), draws.between(3.5, 5.0), draws.between(2.4, 3.0)
    _walls(draws, width, depth, height)
    seat = shape("cube", materials.textured(draws) if draws.maybe() else materials.lacquer(draws))
    chair = _chair(draws, cylinder(materials.metal(draws), 0.025, 0.43, 10), seat)
    top = add("Table", shape("cube", materials.anything(draws)), (0.3, 0.2, 0.74), scale=(1.3, 0.8, 0.05))
    modifier(top, "BEVEL", width=0.01, segments=2)
    leg = cylinder(materials.metal(draws), 0.04, 0.7)
    for x, y in ((-0.2, -0.1), (0.8, -0.1), (-0.2, 0.5), (0.8, 0.5)):
        add("Leg", leg, (x, y, 0.36))
    for x, y, turn in ((-0.65, 0.2, 1.6), (1.3, 0.2, -1.5), (0.1, 0.95, 0.1), (0.6, -0.65, 3.0)):
        turn += draws.between(-0.4, 0.4)
        instance(chair, (x, y, 0.004), (0, 0, turn), (draws.pick((1, -1)), 1, 1))
    for at in range(draws.randint(2, 8)):
        ware = draws.pick(("uvsphere", "cone", "cube"))
        size = draws.between(0.06, 0.16)
        place = (draws.between(-0.2, 0.8), draws.between(-0.1, 0.5), 0.77 + size / 2)
        add("Ware", shape(ware, materials.anything(draws), at % 2 == 0), place, scale=(size, size, size))
    _rug(draws, (-0.2, -0.9, 0.012))
    _lamp(draws, (width / 2 - 0.5, depth / 2 - 0.6, draws.between(1.1, 1.5)))
    _downlights(draws, width, height)
    if draws.maybe():
        hang = [(0.3, 0.2, height), (0.3, 0.2, 2.0), (0.32, 0.2, 1.7)]
        curve(hang, materials.plain(draws), 0.01)
        glow = materials.glow(draws, draws.between(8, 20))
        add("Pendant", shape("icosphere", glow, True, subdivisions=3, radius=0.12), (0.32, 0.2, 1.55))
    picture = add(
        "Picture", shape("cube", materials.textured(draws, 1.0)), (0.2, depth / 2 - 0.02, 1.6), scale=(1.0, 0.03, 0.7)
    )
    modifier(picture, "BEVEL", width=0.005)
    sky(draws)
    if draws.maybe(0.6):
        lamp("SUN", (0, 0, 5), draws.between(1.5, 4.0), rotation_of_sun(draws), angle=draws.between(0.005, 0.05))
    else:
        lamp("AREA", (-width / 2 - 0.6, -0.4, 1.6), 150.0, (0, 0, 1.0), shape="RECTANGLE", size=2.0, size_y=1.5)
    camera((draws.between(-0.6, 0.6), -depth / 2 - 1.2, 1.5), (0.2, 0.6, 1.1), draws.between(20, 30))


def rotation_of_sun(draws: Draws) -> tuple[float, float, float]:
    """A point that a sun above (0, 0, 5) shines to, through the window."""
    return (draws.between(3.0, 6.0), draws.between(-1.0, 2.0), draws.between(0.0, 2.0))


def sky(draws: Draws) -> None:
    """A world of a color, of a computed environment image, or of the Sky Texture."""
    tree = world(draws.color(0.4, (0.3, 0.8)), draws.between(0.5, 2.0))
    graph, background = Graph(tree), tree.nodes["Background"]
    choice = draws.pick(("color", "image", "sky"))
    if choice == "image":
        turn = graph.node(
            "Mapping", Vector=graph.node("TexCoord").outputs["Generated"], Rotation=(0, 0, draws.between(0, 6))
        )
        texture = graph.node("TexEnvironment", {"image": images.image("Sky", images.sky(draws))}, Vector=turn)
        tree.links.new(texture.outputs[0], background.inputs["Color"])
    elif choice == "sky":
        settings = {"sky_type": "MULTIPLE_SCATTERING", "sun_elevation": draws.between(0.2, 1.2), "sun_disc": False}
        tree.links.new(graph.node("TexSky", settings).outputs[0], background.inputs["Color"])
        background.inputs["Strength"].default_value = draws.between(0.05, 0.15)
