# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes in which one light path class L(S|G|D)*E alone reaches the camera, and what it shows there.

A spot lights the first surface of a class only, and the path lengths are as short as the class allows. The camera
looks through pixel centers at the inside of smoothly lit surfaces, farther from the edges than a splat reaches.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
import path_quadrature as quadrature
import pytest
import scenes
from path_constants import (
    FIRST,
    FLOOR,
    FLOOR_AXES,
    NARROW,
    PHOTONS,
    RAYS,
    SECOND,
    SHARP,
    TRACED,
    UP,
    WALL,
    WALL_AXES,
    WIDE,
)
from path_quadrature import Spot
from path_scenes import colored, level, lobe, scattering, scene_of, spot, traced_only, view

from rppm_addon.scene import Camera, DirectLight, Scene


@dataclass
class Case:
    scene: Scene
    expected: Callable[[np.ndarray], np.ndarray]
    """(H, W, 3) radiance if each importon met the photons that lie at an offset (3,), meters."""
    gathers: int | None = None
    """The radius that its photons are gathered with, NARROW or WIDE; None: by rays alone."""
    across: np.ndarray | None = None
    """(2, 3) axes of the surface on which they are gathered."""


Build = Callable[[DirectLight], Case]


def each_mode(names: Iterable[str], each_time: Callable[..., bool] = lambda *_: True) -> list:
    """Names with either way to direct light as parameters of a test; with the long tests those of which it is not true
    that they are tried each time."""
    return [
        pytest.param(
            name, mode, id=f"{name}-{mode.value}", marks=[] if each_time(name, mode) else [pytest.mark.long]
        )
        for name in names
        for mode in DirectLight
    ]  # fmt: skip


# --- a floor that the spot lights, and a wall that it does not -----------------------------------

ON_WALL = view((0.0, -0.4, 1.9), (1.2, -0.2, 1.0), 0.3)
ON_FLOOR = view((1.0, -0.2, 0.9), (0.0, 0.0, 0.0), 0.15)


def corner(
    floor: str | float,
    wall: str | float,
    camera: Camera,
    mode: DirectLight,
    lengths: tuple[int, int],
    radius: float = 0.0,
    half_angle: float | None = None,
    iterations: int = 6,
) -> tuple[Scene, Spot]:
    """Floor and wall of kinds D, S or a roughness, path lengths of photons and camera.

    The cone of a light with an extent is narrower, so that all of its beams still end on the floor.
    """
    light = spot((-1.2, 0.2, 1.0), (0.0, 0.0, 0.0), half_angle or (0.15 if radius else 0.2), radius)
    upright = scenes.rectangle("wall", (1.2, -1.5, 0.02), (1.2, -1.5, 2), (1.2, 1.5, 2), (1.2, 1.5, 0.02))
    surfaces = [(level("floor", 0.0, -1.5, 1.2), lobe(floor, FIRST)), (upright, lobe(wall, SECOND))]
    return scene_of(surfaces, light, camera, mode, *lengths, iterations), Spot.of(light)


def straight(kind: str | float, mode: DirectLight, radius: float = 0.0) -> Case:
    """LDE, LGE: the floor seen straight."""
    scene, light = corner(kind, "D", ON_FLOOR, mode, (1, 2), radius)
    if mode is RAYS or kind == TRACED:
        traced_only(scene, 12 if mode is RAYS else 44)
    origin, directions = quadrature.camera_rays(scene.camera)
    points = FLOOR.hit(origin, directions)

    def expected(offset: np.ndarray) -> np.ndarray:
        return colored(quadrature.lit(light, scattering(kind), UP, points + offset, -directions), FIRST)

    return Case(scene, expected, NARROW if mode is PHOTONS and kind != TRACED else None, FLOOR_AXES)


def two_bounces(first: str | float, second: str | float, mode: DirectLight, radius: float = 0.0) -> Case:
    """LDDE, LGDE, LDGE, LGGE: the wall, lit by the floor, seen straight."""
    scene, light = corner(first, second, ON_WALL, mode, (2, 3), radius, iterations=12 if first == "D" else 6)
    gathered_on_floor = second == TRACED
    splats = not gathered_on_floor or (mode is PHOTONS and first != TRACED)
    if gathered_on_floor:
        scattering_alone = mode is PHOTONS and first == TRACED
        traced_only(scene, 192 if scattering_alone else 32 if splats else 44, 1024 if splats else 64)
    origin, directions = quadrature.camera_rays(scene.camera)
    points = WALL.hit(origin, directions)
    scatters = scattering(first), scattering(second)
    detail = 2 if radius else 14 if first == SHARP else 3

    def expected(offset: np.ndarray) -> np.ndarray:
        # The floor's photons move with their light, the wall's are met beside the importon.
        moved, places = (light.moved(-offset), points) if gathered_on_floor else (light, points + offset)
        picture = quadrature.relit(moved, FLOOR, *scatters, WALL.normal, places, -directions, detail)
        return colored(picture, FIRST, SECOND)

    if gathered_on_floor:
        return Case(scene, expected, NARROW if splats else None, FLOOR_AXES)
    return Case(scene, expected, NARROW if first == SHARP else WIDE, WALL_AXES)


def mirror_then(kind: str | float, mode: DirectLight, radius: float = 0.0) -> Case:
    """LSDE, LSGE: the wall, lit by a mirror, seen straight."""
    scene, light = corner("S", kind, ON_WALL, mode, (2, 3), radius, iterations=4)
    if kind == TRACED:
        traced_only(scene, 64)
    image = light.mirrored(FLOOR)
    origin, directions = quadrature.camera_rays(scene.camera)
    points = WALL.hit(origin, directions)

    def expected(offset: np.ndarray) -> np.ndarray:
        picture = quadrature.lit(image, scattering(kind), WALL.normal, points + offset, -directions)
        return colored(picture, FIRST, SECOND)

    return Case(scene, expected, None if kind == TRACED else NARROW, WALL_AXES)
