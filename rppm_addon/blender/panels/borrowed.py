# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's own panels that make sense for RPPM as well."""

from collections.abc import Iterator

import bpy

from .base import ENGINE

UNFIT = {
    "DATA_PT_light": "shows powers without units; RPPM_PT_light shows what counts",
    "DATA_PT_spot": "as DATA_PT_light",
    "NODE_DATA_PT_light": "as DATA_PT_light",
    "NODE_DATA_PT_spot": "as DATA_PT_light",
    "DATA_PT_falloff_curve": "light falls off with the square of the distance; nodes change that",
    "RENDER_PT_simplify": "would stand before all other panels; RPPM_PT_simplify stands in its place",
    "RENDER_PT_simplify_greasepencil": "as RENDER_PT_simplify",
    "RENDER_PT_simplify_render": "as RENDER_PT_simplify",
    "RENDER_PT_simplify_viewport": "as RENDER_PT_simplify",
    "VIEWLAYER_PT_layer_passes": "is empty without the panels of other engines",
}
"""Panels for all engines that promise something that RPPM does not do, and what."""
FITTING = {
    "DATA_PT_camera_dof",
    "DATA_PT_camera_dof_aperture",
    "EEVEE_MATERIAL_PT_context_material",
    "MATERIAL_PT_preview",
    "VIEWLAYER_PT_override",
}
"""Panels of EEVEE that edit what RPPM reads: depth of field, material slots, and what view layers override."""


def _is_fit(panel: type) -> bool:
    name = panel.__name__
    return name in FITTING or ("BLENDER_RENDER" in panel.COMPAT_ENGINES and name not in UNFIT)


def _panels() -> Iterator[type]:
    for panel in bpy.types.Panel.__subclasses__():
        if hasattr(panel, "COMPAT_ENGINES") and _is_fit(panel):
            yield panel


def register() -> None:
    """Let Blender's panels show while RPPM is the engine."""
    for panel in _panels():
        panel.COMPAT_ENGINES.add(ENGINE)


def unregister() -> None:
    """Take RPPM out of all panels again."""
    for panel in _panels():
        panel.COMPAT_ENGINES.discard(ENGINE)
