# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes of light groups beside Cycles'."""

import bpy
import numpy as np
import pytest

from ..comparison import Tolerance, compare
from ..engines import FIRST_SEED, cycles_channels, render_frame, stacked, unfilter
from ..scenes import DIFFUSE, ball, camera, light, material, new_scene, place, plane

GROUPS = ("key", "sun", "glow", "sky")
CLOSE = Tolerance(mean=0.01, block=0.03, mode=0.01)


def grouped(resolution: int) -> None:
    """A floor and a ball under a lamp, a sun, a card that shines and a sky, each a group, and a lamp of none."""
    scene = new_scene(resolution, world=0.3)
    for group in GROUPS:
        scene.view_layers[0].lightgroups.add(name=group)
    scene.world.lightgroup = "sky"
    plane(1.5, material(DIFFUSE, Color=(0.7, 0.5, 0.3)), place(at=(0.0, 0.0, -0.5)))
    ball(0.35, material(DIFFUSE, Color=(0.2, 0.5, 0.8)), place(at=(-0.4, 0.0, -0.1)))
    card = material("ShaderNodeEmission", Color=(1.0, 0.4, 0.1), Strength=3.0)
    plane(0.3, card, place(at=(0.8, 0.5, 0.2), turn=(70.0, 0.0, 0.0))).lightgroup = "glow"
    light("AREA", 20.0, place(at=(0.3, 0.8, 2.0)), shape="SQUARE", size=1.0).lightgroup = "key"
    light("SUN", 1.0, place(turn=(30.0, 20.0, 0.0)), angle=0.1).lightgroup = "sun"
    light("POINT", 10.0, place(at=(-1.0, -1.0, 1.0)), shadow_soft_size=0.1)
    camera((0.0, -3.0, 1.0), (0.0, 0.0, 0.0), 45.0)


def cycles_groups(samples: int, seed: int = FIRST_SEED) -> dict[str, np.ndarray]:
    """(H, W, 3) by group, and Combined as "", row 0 at the bottom."""
    bpy.context.scene.cycles.seed = seed
    channels = cycles_channels(samples)
    return {group: stacked(channels, f"Combined_{group}") for group in GROUPS} | {"": stacked(channels, "Combined")}


def rppm_groups(renderer, **settings: object) -> dict[str, np.ndarray]:
    frame = render_frame(renderer, **settings)
    return {group: frame.passes[f"Combined_{group}"] for group in GROUPS} | {"": frame.combined[..., :3]}


def test_what_is_seen_to_shine_is_that_of_cycles(renderer):
    """Which has no noise: the sky behind all, and the card."""
    grouped(48)
    unfilter()
    expected = cycles_groups(samples=1)
    mine = rppm_groups(renderer, filter_width=0.0, iterations=1, photons=256)
    for group, value in (("sky", (0.3, 0.3, 0.3)), ("glow", (3.0, 1.2, 0.3))):
        shines, shown = (np.isclose(picture[group], value, rtol=0.01).all(axis=-1) for picture in (mine, expected))
        assert shown.sum() > 30
        assert (shines != shown).sum() <= 0.1 * shown.sum(), f"{group}: more than edges differ"
        others = sum(np.abs(mine[other]) for other in GROUPS if other != group)
        assert others[shines].max() == 0.0


@pytest.mark.long
def test_light_is_that_of_cycles(renderer):
    grouped(32)
    reference = [cycles_groups(1024, FIRST_SEED + seed) for seed in range(3)]
    settings = {"iterations": 64, "photons": 8192}
    mine = [rppm_groups(renderer, seed=seed, **settings) for seed in range(3)]
    for group in (*GROUPS, ""):
        both = (np.array([pictures[group] for pictures in engine], np.float64) for engine in (mine, reference))
        compare(f"light_group_{group or 'combined'}", *both, CLOSE)
