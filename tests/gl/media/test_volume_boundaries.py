# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces of materials that have a volume alone: they are not there, and no limit counts them."""

import numpy as np
import pytest
from support.graphs import surface_graph
from support.lobes import Lobe, LobeKind, material
from test_media import GLOW, LAMP, LIT, WHITE, at, drawn_together, passed, picture, rays, scene_of

from rppm_addon.scene import DirectLight, Material

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
