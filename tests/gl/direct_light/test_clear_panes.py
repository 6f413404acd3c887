# SPDX-License-Identifier: GPL-3.0-or-later
"""Light that shadow rays and a rough reflection find through one pane counts once: both ways to a light are weighted
from where the reflection begins, not from the pane."""

import numpy as np
import pytest
import scenes
from openings import BLACK, FLOOR, room, with_pane
from support.lobes import Lobe, LobeKind, material

from rppm_addon.scene import Light, LightKind, Scene, World

HALF, HEIGHT = 0.4, 1.5
"""Half of the width of a lamp above the hole in the ceiling, and its height over the floor, m."""


def lit_by(kind: str) -> Scene:
    """A room whose floor reflects roughly, with a lamp that has a group of its own."""
    settings = {"use_final_gather": False, "specular_roughness": 0.3, "light_groups": ("lamp",), "passes": ()}
    scene = room(BLACK, iterations=4, photons=64, **settings)
    scene.world = World(BLACK)
    scene.materials[0] = material("floor", Lobe(LobeKind.GLOSSY, roughness=0.25, color=FLOOR))
    if kind == "triangles":
        glow = material("glow", Lobe(LobeKind.EMISSION, color=(1.0, 1.0, 1.0)))
        scenes.add(scene, scenes.square("lamp", HALF, HEIGHT), glow, light_group="lamp")
        return scene
    shape = {"size": (2 * HALF, 2 * HALF)} if kind == "AREA" else {"radius": HALF, "soft_falloff": kind == "soft"}
    matrix = scenes.placed(0.0, 0.0, HEIGHT)
    light_kind = LightKind.AREA if kind == "AREA" else LightKind.POINT
    scene.lights = [Light("lamp", light_kind, matrix, np.ones(3), light_group="lamp", **shape)]
    return scene


@pytest.mark.parametrize("kind", ["triangles", "AREA", "sphere", "soft"])
def test_a_clear_pane_without_shadow_changes_nothing(renderer, kind):
    """With the same random numbers; neither in the picture nor in the light of the lamp's group."""
    scene = lit_by(kind)
    plain = renderer.render(scene).frame.combined[..., :3]
    frame = renderer.render(with_pane(scene, -0.4, 1.05)).frame
    assert frame.combined[..., :3].mean() == pytest.approx(plain.mean(), rel=1e-3)
    np.testing.assert_allclose(frame.passes["Combined_lamp"], frame.combined[..., :3], rtol=2e-6, atol=2e-6)
