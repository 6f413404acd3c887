# SPDX-License-Identifier: GPL-3.0-or-later
"""The transfer curve of sRGB."""

import numpy as np

from rppm_addon.scene.images import decode_srgb, encode_srgb


def test_the_curve_has_the_values_of_the_standard():
    """A linear start up to 0.0031308, and middle gray of 18 % at 0.4614 (IEC 61966-2-1)."""
    np.testing.assert_allclose(encode_srgb(np.array([0.0, 0.002, 0.18, 1.0])), [0.0, 0.02584, 0.46136, 1.0], atol=1e-5)


def test_decoding_is_the_inverse_also_above_1_and_below_0():
    linear = np.linspace(-0.5, 4.0, 100)
    np.testing.assert_allclose(decode_srgb(encode_srgb(linear)), linear, atol=1e-6)
