# SPDX-License-Identifier: GPL-3.0-or-later
"""The scenes of the comparison, and the plain ones in which light sampling alone makes the noise.

The camera sees no sphere that is a light, neither straight nor by mirrors: LuxCore would not show it.
"""

import math

import numpy as np

from .description import (
    AreaLight,
    Camera,
    Diffuse,
    Glass,
    Light,
    Mesh,
    Mirror,
    Scene,
    SphereLight,
    SpotLight,
    SunLight,
    unit,
)
from .shapes import band, box, checkered_floor, floor, quads, room, sphere, washer, waves

_WHITE, _RED, _GREEN = Diffuse((0.75, 0.75, 0.75)), Diffuse((0.65, 0.06, 0.05)), Diffuse((0.12, 0.45, 0.12))
_WOOD, _BLUE = Diffuse((0.45, 0.28, 0.14)), Diffuse((0.15, 0.25, 0.5))
_DOWN = (0.0, 0.0, -1.0)


def glass_box() -> Scene:
    walls = {"floor": _WHITE, "ceiling": _WHITE, "back": _WHITE, "left": _RED, "right": _GREEN}
    ball = sphere("glass ball", (0.25, -0.15, 0.5), 0.4, Glass(1.5))
    lamp = AreaLight("lamp", (0.0, 0.0, 1.98), _DOWN, 0.2, 12.0)
    camera = Camera((0.0, -4.2, 1.0), (0.0, 0.0, 1.0), math.radians(36.0))
    return Scene("glass_box", "Glass ball in a box", [*room(2, 2, 2, walls), ball], [lamp], camera, caustic=True)


def mirror_ring() -> Scene:
    metal = Mirror((0.9, 0.8, 0.6))
    ring = [
        band("inner side", 1.0, 0.0, 0.4, False, metal),
        band("outer side", 1.05, 0.0, 0.4, True, metal),
        washer("rim", 1.0, 1.05, 0.4, metal),
    ]
    lamp = AreaLight("lamp", (-2.4, 0.6, 1.9), unit((2.4, -0.6, -1.7)), 0.1, 40.0)
    camera = Camera((0.0, -3.6, 3.4), (0.0, -0.1, 0.0), math.radians(36.0))
    meshes = [floor("plane", 6.0, _WHITE), *ring]
    return Scene("mirror_ring", "Mirror ring on a plane", meshes, [lamp], camera, caustic=True)


def pool() -> Scene:
    tiles = Diffuse((0.45, 0.65, 0.7))
    basin = [[[x, y, z - 1.4] for x, y, z in mesh.vertices[:4].tolist()] for mesh in room(4, 4, 1.42, _basin(tiles))]
    h, far, z = 2.0, 5.0, 0.02
    deck = [
        [(-far, -far, z), (far, -far, z), (far, -h, z), (-far, -h, z)],
        [(-far, h, z), (far, h, z), (far, far, z), (-far, far, z)],
        [(-far, -h, z), (-h, -h, z), (-h, h, z), (-far, h, z)],
        [(h, -h, z), (far, -h, z), (far, h, z), (h, h, z)],
    ]
    meshes = [quads("basin", basin, tiles), quads("deck", deck, _WHITE), waves("water", h, 160, Glass(1.33))]
    lamp = AreaLight("lamp", (1.5, 1.8, 5.0), unit((-0.3, -0.36, -1.0)), 0.25, 400.0)
    camera = Camera((-0.6, -3.4, 4.4), (0.0, 0.1, -0.6), math.radians(38.0))
    return Scene("pool", "Pool seen through its water", meshes, [lamp], camera, caustic=True)


def _basin(tiles: Diffuse) -> dict[str, Diffuse]:
    return dict.fromkeys(("floor", "left", "right", "front", "back"), tiles)


def interior() -> Scene:
    walls = {"floor": _WOOD, "ceiling": _WHITE, "back": _WHITE, "front": _WHITE, "left": _RED, "right": _WHITE}
    meshes = [
        *room(5, 6, 2.6, walls),
        box("table", (-0.8, 0.3, 0.68), (0.8, 1.3, 0.74), _WOOD),
        *(_leg(x, y) for x in (-0.75, 0.69) for y in (0.35, 1.2)),
        box("cupboard", (1.6, 1.6, 0.0), (2.4, 2.9, 1.9), _BLUE),
        box("sofa", (-2.4, -0.6, 0.0), (-1.5, 1.5, 0.45), _GREEN),
        box("back of the sofa", (-2.48, -0.6, 0.0), (-2.3, 1.5, 0.9), _GREEN),
        sphere("bowl", (0.2, 0.8, 0.89), 0.15, _BLUE, 48),
    ]
    lights: list[Light] = [
        AreaLight("ceiling lamp", (0.0, 0.6, 2.55), _DOWN, 0.5, 60.0),
        SphereLight("floor lamp", (1.9, -2.6, 1.5), 0.12, 25.0, (1.0, 0.75, 0.45)),
    ]
    camera = Camera((0.3, -2.8, 1.5), (-0.1, 1.0, 0.9), math.radians(58.0))
    return Scene("interior", "Room with two lamps", meshes, lights, camera)


def _leg(x: float, y: float) -> Mesh:
    return box(f"leg {x} {y}", (x, y, 0.0), (x + 0.06, y + 0.06, 0.68), _WOOD)


def hall() -> Scene:
    walls = {"floor": _WHITE, "ceiling": _WHITE, "back": _WHITE, "front": _WHITE, "left": _WOOD, "right": _WOOD}
    pillars = [
        box(f"pillar {x} {y}", (x - 0.25, y - 0.25, 0.0), (x + 0.25, y + 0.25, 4.0), _WHITE, 0.3)
        for x in (-2.5, 2.5)
        for y in range(-8, 10, 4)
    ]
    random = np.random.default_rng(7)
    lights: list[Light] = []
    for row in range(20):
        for column in range(10):
            position = (-4.05 + 0.9 * column, -9.5 + row, 3.4 + 0.4 * random.random())
            color = tuple((0.3 + 0.7 * random.random(3)).tolist())
            power = 2.0 * math.exp(random.normal())
            lights.append(SphereLight(f"lamp {row} {column}", position, 0.03, power, color))
    camera = Camera((0.6, -9.6, 3.2), (-0.2, -4.0, -0.3), math.radians(56.0))
    return Scene("hall", "Hall with 200 lamps", [*room(10, 20, 4, walls), *pillars], lights, camera)


def window_room() -> Scene:
    walls = {"floor": _WOOD, "ceiling": _WHITE, "back": _WHITE, "front": _WHITE, "left": _WHITE}
    x, left, right, bottom, top = 2.5, -0.2, 1.6, 0.9, 2.1
    around = [  # the right wall, with a hole
        [(x, -3, 0), (x, -3, 2.6), (x, left, 2.6), (x, left, 0)],
        [(x, right, 0), (x, right, 2.6), (x, 3, 2.6), (x, 3, 0)],
        [(x, left, 0), (x, left, bottom), (x, right, bottom), (x, right, 0)],
        [(x, left, top), (x, left, 2.6), (x, right, 2.6), (x, right, top)],
    ]
    meshes = [
        *room(5, 6, 2.6, walls),
        quads("right", around, _WHITE),
        box("bed", (-1.2, 0.4, 0.0), (0.8, 2.9, 0.5), _BLUE),
        box("chest", (-2.4, 1.8, 0.0), (-1.7, 2.8, 1.1), _RED),
    ]
    sun = SunLight("sun", unit((-0.8, -0.25, -0.75)), 12.0, math.radians(0.53), (1.0, 0.9, 0.75))
    camera = Camera((0.6, -2.8, 1.5), (-0.1, 1.0, 1.0), math.radians(58.0))
    return Scene("window_room", "Room with sun and sky in its window", meshes, [sun], camera, world=1.5)


def gray_world() -> Scene:
    lamp = SphereLight("lamp", (-1.5, -1.0, 4.5), 0.1, 400.0)
    return Scene("gray_world", "Lamp in a gray world", _boxes(), [lamp], _VIEW, world=0.05)


SCENES = {make.__name__: make for make in (glass_box, mirror_ring, pool, interior, hall, window_room, gray_world)}
"""Makers by name."""
QUICK = ("glass_box", "mirror_ring", "gray_world")

_VIEW = Camera((0.0, -7.0, 4.0), (0.0, 0.0, 0.4), math.radians(40.0))


def _boxes() -> list[Mesh]:
    boxes = [
        box("box", (-0.6, -0.6, 0.0), (0.6, 0.6, 1.2), _WHITE, 0.5),
        box("small box", (1.2, -1.0, 0.0), (1.8, -0.4, 0.6), _RED, 0.2),
    ]
    return [floor("plane", 10.0, _WHITE), *boxes]


def _checkers() -> list[Mesh]:
    return checkered_floor(6.0, 24, Diffuse((0.15, 0.15, 0.2)), Diffuse((0.8, 0.75, 0.6)))


def _lamp() -> Light:
    return SphereLight("lamp", (-1.5, -1.0, 4.5), 0.1, 400.0)


def _suns() -> list[Light]:
    angle = math.radians(0.53)
    return [
        SunLight("sun", unit((0.5, 0.4, -1.0)), 2.0, angle, (1.0, 0.9, 0.8)),
        SunLight("second sun", unit((-0.8, 0.2, -0.7)), 0.7, angle, (0.7, 0.8, 1.0)),
    ]


def plain_scenes() -> dict[str, Scene]:
    """By name; each stands in a world of radiance 0.05, Blender's default, and once more in a black one."""
    spot = SpotLight("spot", (-1.5, -1.0, 5.0), unit((0.35, 0.25, -1.0)), 0.1, 600.0, math.radians(50.0))
    kinds: dict[str, tuple[str, list[Mesh], list[Light]]] = {
        "plane": ("plain plane, a lamp", [floor("plane", 10.0, _WHITE)], [_lamp()]),
        "checkers": ("checkered plane, a lamp", _checkers(), [_lamp()]),
        "boxes": ("boxes, a lamp", _boxes(), [_lamp()]),
        "suns": ("boxes, two suns", _boxes(), _suns()),
        "spot": ("boxes, a spot", _boxes(), [spot]),
    }
    found = {}
    for kind, (title, meshes, lights) in kinds.items():
        for suffix, world in (("gray", 0.05), ("black", 0.0)):
            name = f"plain_{kind}_{suffix}"
            found[name] = Scene(name, title, meshes, lights, _VIEW, world=world)
    return found


def make_scene(name: str) -> Scene:
    """A scene of either kind by its name; KeyError where there is none."""
    return SCENES[name]() if name in SCENES else plain_scenes()[name]
