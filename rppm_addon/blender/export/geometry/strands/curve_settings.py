# SPDX-License-Identifier: GPL-3.0-or-later
"""Cycles' settings of curves."""

from dataclasses import dataclass

import bpy

_MOST_PARTS = 16
"""From control point to control point, of curves that Cycles does not divide but intersects as they are."""


@dataclass(frozen=True)
class CurveSettings:
    """How strands are rendered."""

    smooth: bool = True
    """As Catmull-Rom splines through their control points, or else straight from one to the next."""
    most_parts: int = 4
    """Into which strands are divided from control point to control point where they turn."""
    shown: bool = True
    """Whether the view layer has strands."""


def curve_settings(depsgraph: bpy.types.Depsgraph) -> CurveSettings:
    """Return the curve settings of the depsgraph's scene and view layer; Cycles' defaults where it is not enabled."""
    shown = bool(getattr(depsgraph.view_layer_eval, "use_strand", True))
    settings = getattr(depsgraph.scene_eval, "cycles_curves", None)
    shape = getattr(settings, "shape", "RIBBONS")
    parts = 1 << min(settings.subdivisions, 4) if settings is not None and shape == "RIBBONS" else _MOST_PARTS
    return CurveSettings(shape != "THICK_LINEAR", parts if settings is not None else 4, shown)
