# SPDX-License-Identifier: GPL-3.0-or-later
"""Light paths over glossy surfaces are rendered once, whether their roughness makes them stored or traced."""

import numpy as np
import path_quadrature as quadrature
import pytest
from path_classes import Build, Case, each_mode, mirror_then, straight, two_bounces
from path_comparison import compare, gathering
from path_constants import FIRST, FLOOR, FLOOR_AXES, PHOTONS, RAYS, SECOND, SHARP, STORED, THIRD, TRACED, UP, WIDE
from path_quadrature import Spot
from path_scenes import colored, facing_down, level, lobe, scattering, scene_of, spot, view

from rppm_addon.scene import DirectLight

EXTENT = 0.35
"""Radius of the spot, meters, for paths that find it by scattering alone."""
CLASSES: dict[str, Build] = {
    "LGE traced": lambda mode: straight(TRACED, mode, EXTENT),
    "LGE stored": lambda mode: straight(STORED, mode, EXTENT),
    "LGDE sharp": lambda mode: two_bounces(SHARP, "D", mode),
    "LGDE traced": lambda mode: two_bounces(TRACED, "D", mode),
    "LGDE stored": lambda mode: two_bounces(STORED, "D", mode),
    "LDGE traced": lambda mode: two_bounces("D", TRACED, mode),
    "LDGE stored": lambda mode: two_bounces("D", STORED, mode),
    "LGDGE traced": lambda mode: glossy_diffuse_glossy(TRACED, mode),
    "LGDGE stored": lambda mode: glossy_diffuse_glossy(STORED, mode),
    "LSGE traced": lambda mode: mirror_then(TRACED, mode, EXTENT),
    "LSGE stored": lambda mode: mirror_then(STORED, mode, EXTENT),
    "LGGE traced traced": lambda mode: two_bounces(TRACED, TRACED, mode, EXTENT),
    "LGGE traced stored": lambda mode: two_bounces(TRACED, STORED, mode, EXTENT),
    "LGGE stored traced": lambda mode: two_bounces(STORED, TRACED, mode, EXTENT),
    "LGGE stored stored": lambda mode: two_bounces(STORED, STORED, mode, EXTENT),
}
FOUND = {
    "LGDE stored": {RAYS: 64, PHOTONS: 64},
    "LDGE stored": {RAYS: 20, PHOTONS: 20},
    "LGDGE stored": {RAYS: 128, PHOTONS: 24},
    "LGGE stored stored": {RAYS: 64, PHOTONS: 12},
}
"""Where the last surface gets indirect light, from one that stores photons, and the iterations that tell it: their
standard errors are 0.6 to 1 % of the mean."""
OFTEN = {*FOUND, "LGE traced", "LGE stored"}
"""Tried each time: where the last surface finds no indirect light, the gather has nothing to add."""
SELDOM = {
    ("LSGE traced", PHOTONS), ("LGGE traced traced", PHOTONS), ("LGGE stored traced", PHOTONS),
    ("LGDGE stored", RAYS), ("LGDGE stored", PHOTONS),
    ("LGDE sharp", PHOTONS), ("LDGE traced", PHOTONS), ("LGDGE traced", PHOTONS), ("LGGE traced traced", RAYS),
    ("LGE traced", PHOTONS), ("LDGE stored", PHOTONS), ("LGGE stored stored", PHOTONS), ("LGGE traced stored", PHOTONS),
}  # fmt: skip
"""The dearest of their families: in the other mode, gathered or with a lobe that stores photons, the classes are tried
each time."""
GATHERED_SELDOM = {
    ("LGE traced", PHOTONS), ("LGDE stored", PHOTONS), ("LDGE stored", PHOTONS), ("LGDGE stored", RAYS),
    ("LGGE stored stored", RAYS),
}  # fmt: skip
WITHOUT_EXTENT: dict[str, Build] = {
    "LGE point": lambda mode: straight(TRACED, mode),
    "LGGE point": lambda mode: two_bounces(TRACED, TRACED, mode),
}
"""No scattered path meets such a light: by rays alone."""

CEILING, PATCHES = 0.7, 28
"""Height of the ceiling between two glossy surfaces, meters, and quadrature nodes along a side of it."""


def glossy_diffuse_glossy(roughness: float, mode: DirectLight) -> Case:
    """LGDGE: two halves of a floor, which do not see each other, and the ceiling between."""
    light = spot((-1.4, 0.0, 0.45), (-0.6, 0.0, 0.0), 0.12)
    surfaces = [
        (level("lit", 0.0, -1.5, -0.05, 1.0), lobe(roughness, FIRST)),
        (facing_down("ceiling", CEILING, -2.0, 2.0), lobe("D", SECOND)),
        (level("seen", 0.0, 0.05, 1.5, 1.0), lobe(roughness, THIRD)),
    ]
    camera = view((1.1, -0.2, 0.6), (0.75, 0.0, 0.0), 0.35)
    scene = scene_of(surfaces, light, camera, mode, 3, 2)
    iterations, photons = (12, 1024) if roughness == TRACED else (24, 16384)
    scene.settings = scene.settings.with_values(iterations=iterations, photons=photons)
    origin, directions = quadrature.camera_rays(scene.camera)
    points = FLOOR.hit(origin, directions).reshape(-1, 3)
    side, weight = quadrature.gauss_legendre(-2.0, 2.0, PATCHES)
    x, y = np.meshgrid(side, 0.75 * side)
    patches = np.stack([x, y, np.full_like(x, CEILING)], -1).reshape(-1, 3)
    area = 0.75 * np.outer(weight, weight).ravel()
    glossy = scattering(roughness)
    seen = roughness != TRACED

    def expected(offset: np.ndarray) -> np.ndarray:
        places = patches if seen else patches + offset
        radiance = quadrature.relit(Spot.of(light), FLOOR, glossy, quadrature.diffuse, -UP, places, -UP + 0 * places)
        picture = quadrature.gathered(
            patches, -UP, np.pi * radiance * area, glossy, UP,
            points + offset if seen else points, -directions.reshape(-1, 3),
        )  # fmt: skip
        return colored(picture.reshape(directions.shape[:2]), FIRST, SECOND, THIRD)

    return Case(scene, expected, WIDE, FLOOR_AXES)


@pytest.mark.parametrize(("name", "mode"), each_mode(CLASSES, lambda *case: case not in SELDOM))
def test_glossy_paths_are_rendered_once(mapper, name, mode):
    compare(mapper, f"{name} {mode.value}", CLASSES[name](mode))


@pytest.mark.parametrize("name", ["LGE point", pytest.param("LGGE point", marks=pytest.mark.long)])
def test_a_light_without_extent_is_found_by_rays(mapper, name):
    compare(mapper, name, WITHOUT_EXTENT[name](RAYS))


@pytest.mark.parametrize(
    ("name", "mode"), each_mode(CLASSES, lambda *case: case[0] in OFTEN and case not in GATHERED_SELDOM)
)
def test_glossy_paths_are_gathered_once(mapper, monkeypatch, name, mode):
    iterations = FOUND[name][mode] if name in FOUND else None
    case = gathering(CLASSES[name](mode), monkeypatch, iterations)
    compare(mapper, f"{name} gathered {mode.value}", case)
