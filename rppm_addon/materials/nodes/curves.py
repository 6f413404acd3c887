# SPDX-License-Identifier: GPL-3.0-or-later
"""Color ramps and curves. Their tables are made by rppm_addon/blender/export/shading/nodes/tables.py."""

from ...gl.buffers.constants import Constants
from .node_kinds import BOOLEAN, COLOR, FLOAT, VECTOR, NodeKind

TABLE = ("table",)
ENTRIES = 257
"""Number of entries in the table of a ramp or a curve: Cycles cuts the range into 256 parts."""
Constants("CurveTables", ENTRIES=ENTRIES)

KINDS = {
    # `constant`: the ramp's entries are steps; all other interpolations are in the table.
    "val_to_rgb": NodeKind(
        "curves.glsl", {"fac": (FLOAT, 0.5)}, {"color": COLOR, "alpha": FLOAT}, {"constant": BOOLEAN}, TABLE
    ),
    # `extrapolate`: beyond the table curves go on straight instead of level.
    "rgb_curve": NodeKind(
        "curves.glsl",
        {"fac": (FLOAT, 1.0), "color": (COLOR, (1.0, 1.0, 1.0))},
        {"color": COLOR},
        {"extrapolate": BOOLEAN},
        TABLE,
    ),
    "vector_curve": NodeKind(
        "curves.glsl",
        {"fac": (FLOAT, 1.0), "vector": (VECTOR, (0.0, 0.0, 0.0))},
        {"vector": VECTOR},
        {"extrapolate": BOOLEAN},
        TABLE,
    ),
    "float_curve": NodeKind(
        "curves.glsl",
        {"factor": (FLOAT, 1.0), "value": (FLOAT, 1.0)},
        {"value": FLOAT},
        {"extrapolate": BOOLEAN},
        TABLE,
    ),
}
