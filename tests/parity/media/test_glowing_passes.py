# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes of a medium that emits light beside Cycles' of the same name."""

import numpy as np
import pytest

from rppm_addon.scene.passes import PASSES, SCATTERED_LIGHT, VOLUME_LIGHT

from ..engines import FIRST_SEED, cycles_channels, render_frame, stacked
from ..scenes import new_scene
from .test_glowing_media import scattering_cube

LIMITS = {
    "Emission": 0.01,
    "Diffuse Direct": 0.02,
    "Diffuse Indirect": 0.03,
    # Those of paths that Cycles guides (Volume Scatter Probability Guiding) are not the mean in all places.
    "Volume Direct": 0.04,
    "Volume Indirect": 0.06,
    "Combined_glow": 0.01,
}
"""Relative errors of the means of passes."""


@pytest.mark.long
def test_passes_of_glow_are_those_of_cycles(renderer):
    scene = new_scene()
    glow = scattering_cube()
    layer = scene.view_layers[0]
    layer.lightgroups.add(name="glow")
    glow.lightgroup = "glow"
    scene.cycles.volume_bounces, scene.cycles.max_bounces, scene.cycles.seed = 2, 12, FIRST_SEED
    layer.use_pass_emit = True
    for entry in SCATTERED_LIGHT:
        setattr(layer, entry.switch, True)
    layer.cycles.use_pass_volume_direct = layer.cycles.use_pass_volume_indirect = True
    channels = cycles_channels(256)
    layer.cycles.use_pass_volume_direct = layer.cycles.use_pass_volume_indirect = False
    names = tuple(entry.name for entry in PASSES if entry in (*SCATTERED_LIGHT, *VOLUME_LIGHT)) + ("Emission",)
    settings = {"iterations": 24, "photons": 32768, "volume_bounces": 2, "max_bounces": 12, "passes": names}
    frame = render_frame(renderer, **settings)
    for name, limit in LIMITS.items():
        expected = stacked(channels, name)
        assert expected.mean() > 0.01, name
        np.testing.assert_allclose(frame.passes[name].mean(), expected.mean(), rtol=limit, err_msg=name)
