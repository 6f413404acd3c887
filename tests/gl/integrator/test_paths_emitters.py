# SPDX-License-Identifier: GPL-3.0-or-later
"""Light sources are seen once: straight, in a mirror, through glass; as an area light, a mesh and a ball."""

from collections.abc import Callable
from functools import partial

import numpy as np
import path_glass as glass
import path_quadrature as quadrature
import pytest
import scenes
from path_classes import Build, Case, each_mode
from path_comparison import compare
from path_constants import FIRST, FLOOR
from path_quadrature import Plane
from path_scenes import level, lobe, scene_of, traced_only, view
from support.lobes import Lobe, LobeKind

from rppm_addon.scene import DirectLight, Light, LightKind, Mesh

RADIANCE = np.array([3.0, 2.0, 1.0])


def source(kind: str, matrix: np.ndarray) -> tuple[Light | None, list[tuple[Mesh, Lobe]], Callable]:
    """A rectangle of 0.7 x 0.4 or a ball that shines along -Z of a matrix: as a light, as surfaces, and the function
    of rays that tells what they see of it."""
    x, y, center = 0.35 * matrix[:3, 0], 0.2 * matrix[:3, 1], matrix[:3, 3]
    normal = -matrix[:3, 2]

    def rectangle(origins: np.ndarray, directions: np.ndarray) -> np.ndarray:
        place = Plane(center, normal).hit(origins, directions) - center
        inside = (abs(place @ x) < x @ x) & (abs(place @ y) < y @ y) & (directions @ normal < 0)
        return inside[..., None] * RADIANCE

    def ball(origins: np.ndarray, directions: np.ndarray) -> np.ndarray:
        offset = center - origins
        along = quadrature.dot(offset, directions)
        inside = quadrature.dot(offset, offset) - along**2 < 0.2**2
        return inside[..., None] * RADIANCE

    if kind == "area":
        light = Light("light", LightKind.AREA, matrix, RADIANCE, shape="RECTANGLE", size=(0.7, 0.4))
        return light, [], rectangle
    if kind == "ball":
        return Light("light", LightKind.POINT, matrix, RADIANCE * np.pi * 0.2**2, radius=0.2), [], ball
    corners = (center - x - y, center - x + y, center + x + y, center + x - y)
    emission = Lobe(LobeKind.EMISSION, color=tuple(RADIANCE))
    return None, [(scenes.rectangle("light", *map(tuple, corners)), emission)], rectangle


def seen_straight(kind: str, mode: DirectLight) -> Case:
    """LE."""
    light, surfaces, shown = source(kind, scenes.looking((0.9, 0.2, 1.1), (0.0, 0.0, 0.0)))
    surfaces.append((level("floor", 0.0), lobe("D", np.zeros(3))))
    camera = view((-0.6, -0.3, 0.5), (0.9, 0.2, 1.1), 0.3)
    scene = scene_of(surfaces, light, camera, mode, 1, 1, iterations=2, photons=64)
    origin, directions = quadrature.camera_rays(camera)
    return Case(scene, lambda _: shown(origin, directions))


def seen_in_mirror(kind: str, mode: DirectLight) -> Case:
    """LSE by reflection."""
    light, surfaces, shown = source(kind, scenes.looking((0.9, 0.2, 1.1), (0.0, 0.0, 0.0)))
    surfaces.append((level("floor", 0.0), lobe("S", FIRST)))
    camera = view((-0.8, -0.3, 1.2), (0.0, 0.0, 0.0), 0.2)
    scene = scene_of(surfaces, light, camera, mode, 1, 2, iterations=2, photons=64)
    origin, directions = quadrature.camera_rays(camera)
    points = FLOOR.hit(origin, directions)
    return Case(scene, lambda _: FIRST * shown(points, FLOOR.mirrored_direction(directions)))


def seen_through_glass(kind: str, slab: bool, mode: DirectLight) -> Case:
    """LSE by refraction, LSSE through a slab."""
    light, surfaces, shown = source(kind, scenes.looking((0.1, 0.0, 0.21), (0.1, 0.1, 3.0)))
    camera = view((0.6, -0.3, 1.9), (0.0, 0.0, 0.2), 0.25)
    surfaces += glass.panes(slab)
    scene = scene_of(surfaces, light, camera, mode, 1, 3 if slab else 2)
    traced_only(scene, 16)
    origin, directions = quadrature.camera_rays(scene.camera)
    cut = glass.layers(origin[2], slab)[:-1] + [glass.Layer(0.0, glass.AIR if slab else glass.INDEX)]
    points, leaving, share = glass.seen_through(cut, origin, directions)
    return Case(scene, lambda _: share[..., None] * shown(points, leaving))


KINDS = "area", "mesh", "ball"
CLASSES: dict[str, Build] = {
    **{f"LE {kind}": partial(seen_straight, kind) for kind in KINDS},
    **{f"LSE mirror {kind}": partial(seen_in_mirror, kind) for kind in KINDS},
    **{f"LSE interface {kind}": partial(seen_through_glass, kind, False) for kind in KINDS},
    **{f"LSSE slab {kind}": partial(seen_through_glass, kind, True) for kind in KINDS},
}


@pytest.mark.parametrize(("name", "mode"), each_mode(CLASSES))
def test_light_sources_are_seen_once(mapper, name, mode):
    compare(mapper, f"{name} {mode.value}", CLASSES[name](mode))
