# SPDX-License-Identifier: GPL-3.0-or-later
"""Colour spaces of image files, to linear Rec.709."""

from collections.abc import Callable

import numpy as np

_D65, _ACES_WHITE, _EQUAL = (0.3127, 0.3290), (0.32168, 0.33767), (1.0 / 3.0, 1.0 / 3.0)
_REC709 = ((0.64, 0.33), (0.30, 0.60), (0.15, 0.06))
_REC2020 = ((0.708, 0.292), (0.170, 0.797), (0.131, 0.046))
_P3 = ((0.680, 0.320), (0.265, 0.690), (0.150, 0.060))
_AP0, _AP1 = ((0.7347, 0.2653), (0.0, 1.0), (0.0001, -0.077)), ((0.713, 0.293), (0.165, 0.830), (0.128, 0.044))
_BRADFORD = np.array([[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]])


def from_srgb(encoded: np.ndarray) -> np.ndarray:
    """Linear values of sRGB's transfer curve."""
    return np.where(encoded <= 0.04045, encoded / 12.92, ((np.maximum(encoded, 0.0) + 0.055) / 1.055) ** 2.4)


def to_srgb(linear: np.ndarray) -> np.ndarray:
    """Values of sRGB's transfer curve, which goes on above 1."""
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 0.0) ** (1.0 / 2.4) - 0.055)


def _gamma(encoded: np.ndarray) -> np.ndarray:
    return np.maximum(encoded, 0.0) ** 2.4


def _linear(values: np.ndarray) -> np.ndarray:
    return values


def _from_chromaticity(xy: tuple[float, float]) -> np.ndarray:
    return np.array([xy[0] / xy[1], 1.0, (1.0 - xy[0] - xy[1]) / xy[1]])


def _to_xyz(primaries: tuple, white: tuple[float, float]) -> np.ndarray:
    """RGB to XYZ under Rec.709's white, adapted as Bradford does."""
    columns = np.array([_from_chromaticity(xy) for xy in primaries]).T
    matrix = columns * np.linalg.solve(columns, _from_chromaticity(white))
    return _adapted(white) @ matrix


def _adapted(white: tuple[float, float]) -> np.ndarray:
    cones, wanted = _BRADFORD @ _from_chromaticity(white), _BRADFORD @ _from_chromaticity(_D65)
    return np.linalg.solve(_BRADFORD, np.diag(wanted / cones) @ _BRADFORD)


_SPACES: dict[str, tuple[Callable[[np.ndarray], np.ndarray], np.ndarray]] = {
    "Linear Rec.2020": (_linear, _to_xyz(_REC2020, _D65)),
    "Linear DCI-P3 D65": (_linear, _to_xyz(_P3, _D65)),
    "Linear CIE-XYZ D65": (_linear, np.eye(3)),
    "Linear CIE-XYZ E": (_linear, _adapted(_EQUAL)),
    "ACES2065-1": (_linear, _to_xyz(_AP0, _ACES_WHITE)),
    "ACEScg": (_linear, _to_xyz(_AP1, _ACES_WHITE)),
    "Display P3": (from_srgb, _to_xyz(_P3, _D65)),
    "Rec.1886": (_gamma, _to_xyz(_REC709, _D65)),
    "Rec.2020": (_gamma, _to_xyz(_REC2020, _D65)),
}
"""By Blender's name: the curve that decodes, and the matrix to XYZ."""
_XYZ_TO_REC709 = np.linalg.inv(_to_xyz(_REC709, _D65))


def linear_rec709(colors: np.ndarray, space: str) -> np.ndarray | None:
    """(..., 3) colours of a space as linear Rec.709; None for a space that is not known."""
    known = _SPACES.get(space)
    return None if known is None else known[0](colors) @ (_XYZ_TO_REC709 @ known[1]).T
