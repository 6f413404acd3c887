# SPDX-License-Identifier: GPL-3.0-or-later
"""Color ramps and curves as tables of floats, sampled where Cycles samples them."""

import bpy
import numpy as np

from .....materials.nodes.curves import ENTRIES


def ramp_table(color_ramp: bpy.types.ColorRamp) -> np.ndarray:
    """(257, 4) float32 RGBA, scene-linear, over [0, 1]."""
    return np.array([color_ramp.evaluate(i / (ENTRIES - 1)) for i in range(ENTRIES)], np.float32)


def curve_table(mapping: bpy.types.CurveMapping, channels: int) -> np.ndarray:
    """(2 + 257 * channels,) float32: the first and last x of the table, then rows of the channels' values.

    1 channel is a float curve, 3 are a vector curve's, or an RGB curve's where ``mapping`` has a fourth curve,
    which is applied to all of them first. The range is that of all points of all curves.
    """
    mapping.initialize()
    curves = mapping.curves
    low = min(curve.points[0].location[0] for curve in curves)
    high = max(curve.points[len(curve.points) - 1].location[0] for curve in curves)
    combined = curves[3] if len(curves) > 3 else None
    rows = []
    for i in range(ENTRIES):
        x = low + i / (ENTRIES - 1) * (high - low)
        if combined:
            x = mapping.evaluate(combined, x)
        rows.append([mapping.evaluate(curves[channel], x) for channel in range(channels)])
    return np.concatenate([[low, high], np.ravel(rows)]).astype(np.float32)


def extrapolates(mapping: bpy.types.CurveMapping) -> bool:
    """Whether the curves go on straight beyond their range."""
    return mapping.extend == "EXTRAPOLATED"
