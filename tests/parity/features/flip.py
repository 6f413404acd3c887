# SPDX-License-Identifier: GPL-3.0-or-later
"""How different two pictures look: FLIP (Andersson et al. 2020, A Difference Evaluator for Alternating Images)."""

import numpy as np
from scipy.ndimage import correlate

PIXELS_PER_DEGREE = 0.7 * 3840 / 0.7 * np.pi / 180
"""The paper's viewer: 0.7 m from a display 0.7 m wide with 3840 pixels."""
_TO_XYZ = np.array([[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750],
                    [0.0193339, 0.1191920, 0.9503041]])  # fmt: skip
_WHITE = _TO_XYZ.sum(axis=1)
_CONTRAST_SENSITIVITY = (((1.0, 0.0047), (0.0, 1e-5)), ((1.0, 0.0053), (0.0, 1e-5)), ((34.1, 0.04), (13.5, 0.025)))
"""Amplitudes and widths of two Gaussians for luminance, red-green and blue-yellow (table 1)."""
_FEATURE_WIDTH = 0.082
"""Degrees."""


def flip(reference: np.ndarray, test: np.ndarray) -> np.ndarray:
    """(H, W) from 0 (alike) to 1, of pictures (H, W, 3) in display-encoded sRGB from 0 to 1."""
    a, b = (_opponent(_linear(np.asarray(picture, np.float64))) for picture in (reference, test))
    return _color_difference(a, b) ** (1.0 - _feature_difference(a[..., 0], b[..., 0]))


def _linear(encoded: np.ndarray) -> np.ndarray:
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


def _opponent(linear: np.ndarray) -> np.ndarray:
    """CIELAB without its cube roots, in which filtering is linear."""
    x, y, z = np.moveaxis(linear @ _TO_XYZ.T / _WHITE, -1, 0)
    return np.stack([116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)], axis=-1)


def _lab(opponent: np.ndarray) -> np.ndarray:
    """CIELAB of filtered pictures, their colors brought into the gamut, chroma scaled by lightness (Hunt)."""
    y = (opponent[..., 0] + 16.0) / 116.0
    xyz = np.stack([opponent[..., 1] / 500.0 + y, y, y - opponent[..., 2] / 200.0], axis=-1) * _WHITE
    xyz = np.clip(xyz @ np.linalg.inv(_TO_XYZ).T, 0.0, 1.0) @ _TO_XYZ.T / _WHITE
    limit = 6.0 / 29.0
    fx, fy, fz = np.moveaxis(np.where(xyz > limit**3, np.cbrt(xyz), xyz / (3.0 * limit**2) + 4.0 / 29.0), -1, 0)
    lightness = 116.0 * fy - 16.0
    return np.stack([lightness, 0.01 * lightness * 500.0 * (fx - fy), 0.01 * lightness * 200.0 * (fy - fz)], axis=-1)


def _hyab(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.abs(a[..., 0] - b[..., 0]) + np.hypot(a[..., 1] - b[..., 1], a[..., 2] - b[..., 2])


def _grid(radius: int) -> tuple[np.ndarray, np.ndarray]:
    return np.meshgrid(np.arange(-radius, radius + 1.0), np.arange(-radius, radius + 1.0))


def _color_difference(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    x, y = _grid(int(np.ceil(3.0 * np.sqrt(0.04 / (2.0 * np.pi**2)) * PIXELS_PER_DEGREE)))
    squared = (x**2 + y**2) / PIXELS_PER_DEGREE**2
    seen = []
    for picture in (a, b):
        channels = []
        for channel, gaussians in enumerate(_CONTRAST_SENSITIVITY):
            kernel = sum(s * np.sqrt(np.pi / t) * np.exp(-(np.pi**2) * squared / t) for s, t in gaussians)
            channels.append(correlate(picture[..., channel], kernel / kernel.sum(), mode="nearest"))
        seen.append(_lab(np.stack(channels, axis=-1)))
    green, blue = (_lab(_opponent(np.array(color))) for color in ((0.0, 1.0, 0.0), (0.0, 0.0, 1.0)))
    most, difference = _hyab(green, blue) ** 0.7, _hyab(*seen) ** 0.7
    bend = 0.4 * most
    return np.where(difference < bend, 0.95 / bend * difference, 0.95 + (difference - bend) / (most - bend) * 0.05)


def _feature_difference(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    deviation = 0.5 * _FEATURE_WIDTH * PIXELS_PER_DEGREE
    x, y = _grid(int(np.ceil(3.0 * deviation)))
    gaussian = np.exp(-(x**2 + y**2) / (2.0 * deviation**2))
    found = []
    for kernel in (-x * gaussian, (x**2 / deviation**2 - 1.0) * gaussian):
        kernel = np.where(kernel < 0.0, kernel / -kernel[kernel < 0.0].sum(), kernel / kernel[kernel > 0.0].sum())
        strength = [
            np.hypot(*(correlate((picture + 16.0) / 116.0, k, mode="nearest") for k in (kernel, kernel.T)))
            for picture in (a, b)
        ]
        found.append(np.abs(strength[0] - strength[1]))
    return np.sqrt(np.maximum(*found) / np.sqrt(2.0))
