# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes of light beside Cycles' of the same name."""

import bpy
import numpy as np
import pytest

from rppm_addon.scene.passes import PASSES, SCATTERED_LIGHT

from ..comparison import Tolerance, compare
from ..engines import FIRST_SEED, PIXEL_CENTERS, cycles_channels, render_frame, unfilter
from ..scenes import DIFFUSE, GLASS, GLOSSY, PRINCIPLED, ball, camera, light, material, new_scene, place, plane

COLORS = tuple(entry for entry in PASSES if entry.name in {scattered.divided_by for scattered in SCATTERED_LIGHT})
CLOSE = Tolerance(mean=0.03, block=0.06, mode=0.03)


def surfaces(resolution: int) -> None:
    """Build surfaces of all kinds: diffuse floor, glossy, varnished and glass balls, translucent sheet, rough pane."""
    scene = new_scene(resolution, world=0.4)
    plane(1.5, material(DIFFUSE, Color=(0.7, 0.5, 0.3)), place(at=(0.0, 0.0, -0.5)))
    ball(0.35, material(PRINCIPLED, Base_Color=(0.2, 0.5, 0.8), Roughness=0.4), place(at=(-0.7, 0.0, -0.1)))
    ball(0.35, material(GLOSSY, Color=(0.9, 0.7, 0.4), Roughness=0.3), place(at=(0.7, 0.0, -0.1)))
    ball(0.35, material(GLASS, Color=(0.9, 1.0, 0.9), Roughness=0.0, IOR=1.4), place(at=(0.0, 0.1, 0.3)))
    sheet = material("ShaderNodeBsdfTranslucent", Color=(0.8, 0.6, 0.7))
    plane(0.4, sheet, place(at=(0.0, 0.9, 0.4), turn=(70.0, 0.0, 0.0)))
    pane = material("ShaderNodeBsdfRefraction", Color=(0.6, 0.9, 0.7), Roughness=0.5, IOR=1.3)
    plane(0.3, pane, place(at=(-0.7, 0.9, 0.6), turn=(70.0, 0.0, 0.0)))
    light("AREA", 20.0, place(at=(0.3, 0.8, 2.0)), shape="SQUARE", size=1.0)
    camera((0.0, -3.0, 1.0), (0.0, 0.0, 0.0), 45.0)
    for entry in (*SCATTERED_LIGHT, *COLORS):
        setattr(scene.view_layers[0], entry.switch, True)


def cycles_passes(samples: int, seed: int = FIRST_SEED) -> dict[str, np.ndarray]:
    """(H, W, 3) by name, row 0 at the bottom."""
    bpy.context.scene.cycles.seed = seed
    channels = cycles_channels(samples)
    wanted = (*SCATTERED_LIGHT, *COLORS)
    return {entry.name: np.stack([channels[layer] for layer in entry.layers], axis=-1) for entry in wanted}


def test_colors_are_those_of_cycles(renderer):
    surfaces(48)
    unfilter()
    expected = cycles_passes(samples=1)
    names = tuple(entry.name for entry in COLORS)
    frame = render_frame(renderer, **PIXEL_CENTERS, passes=names)
    for name in names:
        same = np.isclose(frame.passes[name], expected[name], rtol=0.01, atol=2e-3).all(axis=-1)
        assert same.mean() > 0.98, f"{name}: more than edges differ"
        assert expected[name].std() > 0.0, f"{name}: nothing is shown"


@pytest.mark.long
def test_light_is_that_of_cycles(renderer):
    surfaces(32)
    reference = [cycles_passes(1024, FIRST_SEED + seed) for seed in range(3)]
    names = tuple(entry.name for entry in (*SCATTERED_LIGHT, *COLORS))
    settings = {"iterations": 64, "photons": 16384, "passes": names}
    mine = [render_frame(renderer, seed=seed, **settings).passes for seed in range(3)]
    for entry in SCATTERED_LIGHT:
        # Of quotients over the colors of edges, next to nothing is known.
        both = [
            np.array([passes[entry.name] * passes[entry.divided_by] for passes in engine], np.float64)
            for engine in (mine, reference)
        ]
        compare(entry.name.lower().replace(" ", "_"), *both, CLOSE)
