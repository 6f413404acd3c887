# SPDX-License-Identifier: GPL-3.0-or-later
"""Sky Textures by vectors of any length, of which Cycles takes z alone for how high they point."""

import numpy as np
import pytest

from ..engines import PIXEL_CENTERS, cycles_pass, render_frame, unfilter
from ..net import Net, material
from ..scenes import ball, camera, new_scene


def sky(net: Net, **inputs: object) -> object:
    kinds = {"HOSEK_WILKIE"} & set(net.node("TexSky").bl_rna.properties["sky_type"].enum_items.keys())
    made = net.node("TexSky", inputs, sky_type=kinds.pop() if kinds else "PREETHAM")
    return made.outputs[0]


def generated(net: Net) -> object:
    """The vector where nothing is linked: 0 to 1 along the axes."""
    return sky(net)


def longer(net: Net) -> object:
    """Beyond 1 as well, and below the horizon."""
    return sky(net, Vector=net.scaled(net.out("TexCoord", "Object"), 1.5, 0.2))


@pytest.mark.parametrize("give", [generated, longer], ids=lambda give: give.__name__)
def test_a_sky_on_a_surface(renderer, give):
    new_scene()
    made, net = material("Feature")
    net.output(net.emission(give(net)))
    ball(1.0, made, segments=32)
    camera((0.3, -4.0, 1.5), (0.0, 0.0, 0.0), 15.0)
    unfilter()
    theirs = cycles_pass()
    difference = np.abs(render_frame(renderer, **PIXEL_CENTERS).combined[..., :3] - theirs).max(axis=-1)
    assert np.percentile(difference, 97) < 0.02 * theirs.max()
