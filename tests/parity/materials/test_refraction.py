# SPDX-License-Identifier: GPL-3.0-or-later
"""Glass: a slab, a sphere's caustic, a caustic seen through glass, against Cycles with large lights."""

import numpy as np
import pytest

from ..comparison import BLOCK, CAUSTIC, block_means, compare
from ..engines import compare_with_cycles, render_cycles, render_rppm
from ..scenes import DIFFUSE, GLASS, ball, box, camera, light, material, new_scene, place, plane

PATHS = {"photon_path_length": 20, "camera_path_length": 20}


def _clear_glass(**inputs):
    return material(GLASS, **({"Color": 1.0, "Roughness": 0.0, "IOR": 1.5} | inputs))


@pytest.mark.parametrize("mode", ["RAYS", pytest.param("PHOTONS", marks=pytest.mark.long)])
def test_glass_slab(renderer, mode):
    """A thick pane over a diffuse floor: all that is below it is lit and seen through glass."""
    new_scene(world=0.3)
    plane(3.0, material(DIFFUSE, Color=(0.7, 0.5, 0.3)))
    box((1.0, 1.0, 0.2), _clear_glass(), place(at=(0.0, 0.0, 0.5)))
    light("AREA", 200.0, place(at=(0.0, 0.0, 3.0)), shape="SQUARE", size=3.0)
    camera((0.0, -2.4, 3.4), (0.0, 0.0, 0.3), 36.0)
    compare_with_cycles(renderer, f"slab_{mode.lower()}", 1024, direct_light=mode, photons=32768, iterations=8, **PATHS)


def _ball_over_floor() -> None:
    plane(3.0, material(DIFFUSE, Color=0.8))
    ball(0.5, _clear_glass(), place(at=(0.0, 0.0, 0.9)))
    light("AREA", 200.0, place(at=(0.8, 0.0, 4.0), turn=(0.0, 11.0, 0.0)), shape="DISK", size=1.2)


def _compare_caustic(renderer, name: str, mode: str) -> None:
    camera((0.0, -2.6, 2.6), (-0.1, 0.0, 0.2), 32.0)
    reference = render_cycles(samples=4096)
    pictures = render_rppm(renderer, direct_light=mode, photons=49152, iterations=24, **PATHS)
    compare(name, pictures, reference, CAUSTIC, _caustic_blocks(reference))


def _caustic_blocks(reference: np.ndarray, factor: float = 1.3) -> np.ndarray:
    """Blocks clearly brighter than the floor around: the caustic."""
    level = block_means(reference.mean(axis=0))
    found = level > factor * np.median(level)
    assert 2 <= found.sum() <= found.size // 3, f"{found.sum()} of the {BLOCK}x{BLOCK} blocks hold the caustic"
    return found


@pytest.mark.long
@pytest.mark.parametrize("mode", ["RAYS", "PHOTONS"])
def test_caustic_of_a_glass_ball(renderer, mode):
    new_scene()
    _ball_over_floor()
    _compare_caustic(renderer, f"caustic_{mode.lower()}", mode)


@pytest.mark.long
@pytest.mark.parametrize("mode", ["RAYS", "PHOTONS"])
def test_caustic_seen_through_glass(renderer, mode):
    """The ball's caustic lies behind a pane between it and the camera: specular, diffuse, specular."""
    new_scene()
    _ball_over_floor()
    box((1.6, 0.1, 1.4), _clear_glass(Color=(0.8, 0.95, 0.9)), place(at=(0.0, -1.6, 1.5)))
    _compare_caustic(renderer, f"caustic_through_glass_{mode.lower()}", mode)
