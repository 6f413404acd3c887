# SPDX-License-Identifier: GPL-3.0-or-later
"""The blur of Filter Glossy that photons and the final gather take."""

import numpy as np
import pytest

from rppm_addon.scene import RenderSettings


@pytest.mark.parametrize("strength", [0.05, 0.2, 0.31831, 0.5, 1.0, 10.0])
def test_it_is_the_mean_over_a_diffuse_bounce(strength):
    cosine = (np.arange(100_000) + 0.5) / 100_000
    alpha = 0.5 * np.sqrt(np.maximum(1.0 - cosine / np.pi / strength, 0.0))
    assert RenderSettings(blur_glossy=strength).gathered_alpha == pytest.approx((2.0 * cosine * alpha).mean(), rel=1e-4)


def test_without_a_strength_there_is_none():
    assert RenderSettings().gathered_alpha == RenderSettings().filter_pdf_scale == 0.0
