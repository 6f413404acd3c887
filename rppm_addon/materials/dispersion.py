# SPDX-License-Identifier: GPL-3.0-or-later
"""Indices of refraction by wavelength, and the colors of wavelengths.

A path whose light is dispersed has one wavelength, of all alike in probability as the table below spaces them. What
first refracts it colors it; the mean of these colors is white.

Indices follow Cauchy's equation n = A + B / wavelength^2 with two terms, by the index n_d at the line d and the Abbe
number V_d = (n_d - 1) / (n_F - n_C). So
n = n_d + (n_d - 1) / V_d shift, where the shift is that of the wavelength alone.
"""

import numpy as np

from ..gl.buffers.constants import Constants
from ..scene.node_graphs import NodeGraph
from . import albedo_tables
from .colorimetry import XYZ_TO_REC709
from .traits.emitted import reachable

LINE_F, LINE_D, LINE_C = 486.13e-9, 587.56e-9, 656.27e-9
"""Meters: Fraunhofer's lines by which glasses are classified."""
STEPS = 64
SHORTEST, LONGEST = 390e-9, 710e-9
"""Meters. Beyond, eyes see less than a thousandth of the light."""
_STEP = 0.1e-9

_REFRACTING = {"bsdf_glass", "bsdf_refraction", "bsdf_principled"}


def _bell(wavelength: np.ndarray, center: float, below: float, above: float) -> np.ndarray:
    offset = 1e9 * wavelength - center
    return np.exp(-0.5 * (offset / np.where(offset < 0.0, below, above)) ** 2)


def color_matching(wavelength: np.ndarray) -> np.ndarray:
    """(n, 3) the CIE 1931 observer (2 degrees) at (n,) wavelengths, meters, as Wyman, Sloan and Shirley fit it (Simple
    Analytic Approximations to the CIE XYZ Color Matching Functions, JCGT 2013)."""
    lobes = (
        ((1.056, 599.8, 37.9, 31.0), (0.362, 442.0, 16.0, 26.7), (-0.065, 501.1, 20.4, 26.2)),
        ((0.821, 568.8, 46.9, 40.5), (0.286, 530.9, 16.3, 31.1)),
        ((1.217, 437.0, 11.8, 36.0), (0.681, 459.0, 26.0, 13.8)),
    )
    return np.stack([sum(height * _bell(wavelength, *at) for height, *at in each) for each in lobes], axis=-1)


def index_shift(wavelength: np.ndarray) -> np.ndarray:
    """By how much the index differs from n_d, times (n_d - 1) / V_d; wavelengths in meters."""
    return (wavelength**-2 - LINE_D**-2) / (LINE_F**-2 - LINE_C**-2)


def wavelengths() -> np.ndarray:
    """(STEPS + 1,) meters: between each two lies as much of the three channels' light."""
    fine, seen = _seen()
    return np.interp(np.linspace(0.0, 1.0, STEPS + 1), _cumulated(seen.sum(axis=1)), fine)


def table() -> np.ndarray:
    """(STEPS + 1, 4) float32: at the wavelengths, linear between them, the color in linear Rec.709 and the index's
    shift. What lies outside of Rec.709 is cut off at zero; the mean is (1, 1, 1)."""
    fine, seen = _seen()
    at = wavelengths()
    colors = np.stack([np.interp(at, fine, channel) for channel in seen.T], axis=1)
    colors /= colors.sum(axis=1, keepdims=True)
    mean = albedo_tables.trapezoid(colors.T, np.linspace(0.0, 1.0, STEPS + 1))
    return np.column_stack([colors / mean, index_shift(at)]).astype(np.float32)


def disperses(graph: NodeGraph) -> bool:
    """Whether an Abbe number makes a difference to what a surface scatters."""
    return any(graph.nodes[index].kind in _REFRACTING for index in reachable(graph, graph.surface))


def _seen() -> tuple[np.ndarray, np.ndarray]:
    """(n,) wavelengths, and (n, 3) the channels' light of each, all channels' alike."""
    fine = np.arange(SHORTEST, LONGEST + _STEP / 2, _STEP)
    seen = np.maximum(color_matching(fine) @ XYZ_TO_REC709.T, 0.0)
    return fine, seen / seen.sum(axis=0)


def _cumulated(density: np.ndarray) -> np.ndarray:
    ends = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]))])
    return ends / ends[-1]


def mean(values: np.ndarray) -> np.ndarray:
    """Return the mean over all paths of (STEPS + 1, ...) values at the wavelengths of the table."""
    return 0.5 * (values[1:] + values[:-1]).mean(axis=0)


def _channel_means() -> np.ndarray:
    """(3,) the mean shift of the index of a channel's light."""
    values = table().astype(float)
    return mean(values[:, :3] * values[:, 3:])


def channel_shifts() -> np.ndarray:
    """(3,) by how much the shift of the index of a channel's light differs from that of all, in the mean."""
    return _channel_means() - mean(table()[:, 3].astype(float))


def fitted(indices: np.ndarray) -> tuple[float, float]:
    """n_d and V_d of a glass in which red, green and blue light have these (3,) indices in the mean, or nearly: by
    least squares. V_d is infinite where they are the same, and negative where blue has the least."""
    spread, index = np.polyfit(_channel_means(), indices, 1)
    return float(index), float((index - 1.0) / spread) if abs(spread) > 1e-9 else float("inf")


Constants(
    "DispersionTable",
    signed=True,
    WAVELENGTH_STEPS=STEPS,
    DISPERSION_TABLE=albedo_tables.length(),
    SHIFT_OF_CHANNELS=channel_shifts().tolist(),
)
