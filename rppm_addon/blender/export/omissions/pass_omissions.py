# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes that a view layer may ask for and RPPM does not have."""

import bpy

from .omission import of_cycles

PASSES = {
    "use_pass_shadow": "Shadow",
    "use_pass_subsurface_direct": "Subsurface Direct",
    "use_pass_subsurface_indirect": "Subsurface Indirect",
    "use_pass_subsurface_color": "Subsurface Color",
    "use_pass_grease_pencil": "Grease Pencil",
    "cycles.use_pass_volume_scatter": "Volume Scatter",
    "cycles.use_pass_volume_transmit": "Volume Transmit",
    "cycles.use_pass_volume_majorant": "Volume Majorant",
    "cycles.pass_render_time": "Render Time",
}
"""Labels of the passes that RPPM does not have, by the switch of a view layer."""


def passes_without(layer: bpy.types.ViewLayer) -> list[str]:
    """Labels of the passes that a view layer has switched on and RPPM does not have."""
    return [
        label
        for path, label in PASSES.items()
        if (
            of_cycles(layer, path.removeprefix("cycles."), False)
            if path.startswith("cycles.")
            else getattr(layer, path, False)
        )
    ]
