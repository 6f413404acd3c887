# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces of materials that have a volume alone: they are not there, and no limit counts them."""

import dataclasses

import numpy as np
import pytest
from support.graphs import surface_graph
from support.lobes import Lobe, LobeKind, material
from test_media import GLOW, LAMP, LIT, WHITE, at, drawn_together, passed, picture, rays, scene_of

from rppm_addon.scene import DirectLight, LightLinking, Material

COLOR = (1.0, 0.5, 0.2)
ABSORPTION = 1.0 - np.array(COLOR)


def clear(density: float = 1.0) -> Material:
    """A material of a volume alone."""
    fog = surface_graph("volume_absorption", color=COLOR, density=density)
    return Material("body", surface_graph("volume_boundary"), fog)


def nested(*others, body: Material, **settings):
    """Four boxes around the camera, one in another."""
    boxes = [(0, at(0.0, 0.2 * k), 0) for k in range(1, 5)]
    return scene_of(*boxes, *others, body=body, transparent_max_bounces=0, **settings)


def test_a_card_seen_through_several(renderer):
    scene = nested((1, at(-1.0), GLOW), body=clear())
    length = sum(0.2 * k * drawn_together(at(0.0, 0.2 * k), k - 1) for k in range(1, 5))
    np.testing.assert_allclose(picture(renderer, scene), passed(length * rays(), ABSORPTION), rtol=1e-5)


def test_transparent_surfaces_are_counted(renderer):
    body = material("body", Lobe(LobeKind.TRANSPARENT), absorption=ABSORPTION)
    assert not picture(renderer, nested((1, at(-1.0), GLOW), body=body)).any()


@pytest.mark.parametrize("mode", DirectLight)
def test_light_of_a_lamp_through_several(renderer, mode):
    """The lamp is as far above the camera as the card is below; both are outside."""
    within, plain = (
        picture(
            renderer,
            nested((1, at(-1.0, 0.5), WHITE), body=clear(density), lights=[LAMP], direct_light=mode, **LIT),
        )
        for density in (1.0, 1e-12)
    )
    assert (plain > 0.0).mean() > 0.9
    expected = plain * passed(2.0 * rays() + 2.0 * rays(2.0), ABSORPTION)
    np.testing.assert_allclose(within, expected, rtol=3e-3)


@pytest.mark.parametrize("in_the_way", ["nothing", "a pane", "light linking"])
def test_shadow_rays_through_several(renderer, in_the_way):
    """Also where a transparent surface within is to be resolved, and where the light is linked."""
    pane, lamp = material("pane", Lobe(LobeKind.TRANSPARENT, color=(0.5, 0.7, 0.9))), LAMP
    if in_the_way == "light linking":
        lamp = dataclasses.replace(LAMP, linking=LightLinking(shadow_set_membership=0b01))
    pictures = []
    for density in (1.0, 1e-12):
        others = [(1, at(-1.0, 0.5), WHITE)] + [(1, at(0.3), 3)] * (in_the_way == "a pane")
        scene = nested(*others, body=clear(density), lights=[lamp], direct_light=DirectLight.RAYS, **LIT)
        scene.materials.append(pane)
        scene.settings = scene.settings.with_values(transparent_max_bounces=1)
        pictures.append(picture(renderer, scene))
    within, plain = pictures
    assert (plain > 0.0).mean() > 0.9
    np.testing.assert_allclose(within, plain * passed(2.0 * rays() + 2.0 * rays(2.0), ABSORPTION), rtol=3e-3)


def test_a_dense_volume_lets_its_part_pass(renderer):
    """Shadow rays of which media leave little end by chance: the mean is what passes. The lamp is outside."""
    gray = surface_graph("volume_absorption", color=(0.0, 0.0, 0.0), density=2.0)
    lamp = dataclasses.replace(LAMP, matrix=at(2.0))
    x = 0.15 * (2 * (np.arange(8) + 0.5) / 8 - 1)  # at the card
    slant = np.sqrt(2.5**2 + x**2 + x[:, None] ** 2)[..., None] / 2.5
    top = drawn_together(at(0.0))
    expected = np.exp(-2.0 * (0.5 * rays() + (0.5 + top) * slant))
    ratios = []
    for seed in range(12):
        pair = []
        for fog in (gray, surface_graph("volume_absorption", color=(0.0, 0.0, 0.0), density=1e-12)):
            body = Material("body", surface_graph("volume_boundary"), fog)
            scene = scene_of((0, at(0.0), 0), (1, at(-0.5, 0.5), WHITE), body=body, lights=[lamp], seed=seed, **LIT)
            pair.append(picture(renderer, scene))
        ratios.append(float(np.mean(pair[0] / (pair[1] * expected))))
    error = np.std(ratios, ddof=1) / len(ratios) ** 0.5
    assert 0.0 < error < 0.03, "some rays end, and some do not"
    assert abs(np.mean(ratios) - 1.0) < 4.0 * error
