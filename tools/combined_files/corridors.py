# SPDX-License-Identifier: GPL-3.0-or-later
"""Corridors of science fiction: strips of light, fog, mirrors, decals, mirrored duplicates."""

import math

import bpy

from . import images, materials
from .draws import Draws
from .graphs import finish, material
from .scenes import add, camera, curve, cylinder, kind, lamp, modifier, shape, text, world


def _panels(draws: Draws) -> list[bpy.types.Mesh]:
    paints = [
        materials.metal(draws),
        materials.textured(draws, 2.0),
        materials.plain(draws),
        materials.procedural(draws),
    ]
    return [shape("cube", draws.pick(paints)) for _ in range(3)]


def _decal(draws: Draws) -> bpy.types.Mesh:
    made, graph = material("Decal")
    picture = graph.node("TexImage", {"image": images.image("Decal", images.leaf(draws)), "extension": "CLIP"})
    mask = picture.outputs[1] if draws.maybe() else graph.math("GREATER_THAN", picture.outputs[1], 0.5)
    shader = graph.node("BsdfPrincipled", Base_Color=draws.color(0.9), Alpha=mask, Emission_Color=draws.color(0.9))
    shader.inputs["Emission Strength"].default_value = draws.pick((0.0, 0.0, 1.0))
    finish(graph, shader)
    return shape("grid", made)


def _fog(draws: Draws, length: float) -> None:
    """A box of fog around all; it scatters, and sometimes it is uneven."""
    made, graph = material("Fog")
    density = draws.between(0.02, 0.1)
    if draws.maybe(0.4):
        noise = graph.node("TexNoise", Scale=0.8, Vector=graph.node("TexCoord").outputs["Object"])
        spread = graph.math("MULTIPLY", noise, 2 * density)
    else:
        spread = density
    if draws.maybe():
        volume = graph.node("VolumeScatter", Color=draws.color(0.3, (0.7, 1.0)), Density=spread)
    else:
        volume = graph.node("VolumePrincipled", Color=draws.color(0.3, (0.7, 1.0)), Density=spread)
    finish(graph, volume=volume)
    add("Fog", shape("cube", made), (0, length / 2, 1.2), scale=(3.9, length + 6.0, 3.9))


@kind
def corridor(draws: Draws) -> None:
    """A corridor of linked panels, half of them mirrored, with strips of light."""
    length, width, height = draws.between(6, 10), draws.between(2.0, 2.8), 2.4
    panels, ribs = _panels(draws), shape("cube", materials.metal(draws))
    strip = shape("cube", materials.glow(draws, draws.between(3, 12)))
    decal = _decal(draws)
    steps = int(length)
    for at in range(steps):
        panel = panels[at % len(panels)]
        for side in (-1, 1):
            wall = add(
                "Panel", panel, (side * (width / 2 + 0.05), at + 0.5, height / 2), scale=(-0.1 * side, 0.96, height)
            )
            if at < 2:
                modifier(wall, "BEVEL", width=0.03, segments=2)
            add(
                "Rib",
                ribs,
                (side * (width / 2 - 0.03), at, height / 2 - 0.001),
                scale=(0.12 * side, 0.08, height - 0.006),
            )
            if draws.maybe(0.5):
                place = (side * (width / 2 - 0.004), at + 0.5, draws.between(1.0, 1.6))
                add("Decal", decal, place, (math.pi / 2, 0, -side * math.pi / 2), (0.5, 0.5, 1))
        add("Ceiling", panels[(at + 1) % 3], (0, at + 0.5, height + 0.053), scale=(width, 0.97, 0.1))
        if draws.maybe(0.7):
            add("Strip", strip, (draws.pick((-0.5, 0.0, 0.5)), at + 0.5, height - 0.03), scale=(0.12, 0.7, 0.03))
    floor = materials.metal(draws) if draws.maybe() else materials.textured(draws, 6.0)
    add("Floor", shape("cube", floor), (0, length / 2 - 1, -0.055), scale=(width + 0.4, length + 4, 0.1))
    end = draws.pick(("mirror", "glow", "wall"))
    paint = {"mirror": materials.principled("Mirror", (0.9, 0.9, 0.9, 1), Metallic=1.0, Roughness=0.0),
             "glow": materials.glow(draws, 2.0), "wall": materials.procedural(draws)}[end]  # fmt: skip
    add("End", shape("cube", paint), (0, length + 0.06, height / 2), scale=(width + 0.3, 0.1, height + 0.1))
    for side in (-1, 1):
        points = [(side * (width / 2 - 0.15), y, height - 0.2 + 0.05 * math.sin(y)) for y in range(-1, steps)]
        curve(points, materials.plain(draws), 0.03)
    for _ in range(draws.randint(1, 5)):
        place = (draws.between(-0.6, 0.6), draws.between(1.5, length - 1), 0.3)
        thing = draws.pick(("crate", "tank", "sphere"))
        if thing == "crate":
            add("Crate", shape("cube", materials.anything(draws)), place, (0, 0, draws.random()), (0.5, 0.5, 0.59))
        elif thing == "tank":
            add("Tank", cylinder(materials.glass(draws), 0.2, 0.58), place)
            add("Core", cylinder(materials.glow(draws, 2.0), 0.08, 0.4), place)
        else:
            add("Sphere", shape("uvsphere", materials.anything(draws), True, radius=0.28), place)
    text(
        draws.pick(("DECK 7", "EXIT", "42")),
        materials.glow(draws, 3.0),
        (-0.5, length - 0.1, 1.7),
        size=0.4,
        extrude=0.02,
    )
    if draws.maybe(0.5):
        _fog(draws, length)
    for at in range(draws.randint(0, 3)):
        color = draws.color(0.9, (0.8, 1.0))[:3]
        lamp("POINT", (0.3, 1.5 + 2 * at, 1.9), draws.between(5, 30), shadow_soft_size=0.08, color=color)
    world((0.02, 0.02, 0.03))
    camera((draws.between(-0.4, 0.4), -0.8, 1.3), (0, length, 1.1), draws.between(18, 28))
