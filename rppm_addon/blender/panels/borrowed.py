# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's own panels that make sense for RPPM as well."""

from collections.abc import Iterator

import bpy

ENGINE = "RPPM"

UNFIT = {
    "DATA_PT_light",  # without units; ours shows what counts
    "DATA_PT_spot",
    "NODE_DATA_PT_light",
    "NODE_DATA_PT_spot",
    "DATA_PT_falloff_curve",
    "MATERIAL_PT_preview",
    "RENDER_PT_freestyle",
    "RENDER_PT_gpencil",
    "RENDER_PT_simplify",
    "VIEWLAYER_PT_layer_passes",
}
"""Panels for all engines that promise something that RPPM does not do."""

FITTING = {
    "DATA_PT_camera_dof",
    "DATA_PT_camera_dof_aperture",
    "EEVEE_MATERIAL_PT_context_material",
    "EEVEE_MATERIAL_PT_surface",
    "EEVEE_MATERIAL_PT_volume",
    "EEVEE_WORLD_PT_surface",
}
"""Panels of EEVEE that edit what RPPM reads: depth of field, material slots and node trees."""


def _panels() -> Iterator[type]:
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", None)
        if engines is None:
            continue
        if ("BLENDER_RENDER" in engines and panel.__name__ not in UNFIT) or panel.__name__ in FITTING:
            yield panel


def register() -> None:
    """Let Blender's panels show while RPPM is the engine."""
    for panel in _panels():
        panel.COMPAT_ENGINES.add(ENGINE)


def unregister() -> None:
    """Take RPPM out of all panels again."""
    for panel in _panels():
        panel.COMPAT_ENGINES.discard(ENGINE)
