# SPDX-License-Identifier: GPL-3.0-or-later
"""Which passes a view layer has switched on."""

import bpy

from ....scene.passes import ALWAYS_TAKEN, PASSES, RenderPass, light_group_passes

OF_CYCLES = {
    "denoising_store_passes": "use_pass_denoising_data",
    "use_pass_shadow_catcher": "use_pass_shadow_catcher",
    "pass_debug_sample_count": "use_pass_debug_sample_count",
    "use_pass_volume_direct": "use_pass_volume_direct",
    "use_pass_volume_indirect": "use_pass_volume_indirect",
}
"""Switches that Cycles adds to view layers, with those of the add-on for the same passes."""


def switch_of(layer: bpy.types.ViewLayer, entry: RenderPass) -> tuple[bpy.types.bpy_struct | None, str]:
    """Return the owner of the pass's switch, and the switch's name. The owner is the view layer, or the add-on's
    properties of it, which are None where the extension is not registered."""
    return (layer, entry.switch) if entry.switch else (getattr(layer, "rppm", None), entry.own_switch)


def aovs_of_layer(layer: bpy.types.ViewLayer) -> tuple[str, ...]:
    """The AOVs of a view layer, as settings have them; those that have the name of another pass are left out: Blender
    shows that beside them."""
    others = (*passes_of_layer(layer), *light_group_passes(light_groups_of_layer(layer)))
    taken = ALWAYS_TAKEN | {entry.name for entry in others}
    valid = {aov.name: aov.type for aov in layer.aovs if aov.is_valid and aov.name not in taken}
    return tuple(f"{name}.{'X' if kind == 'VALUE' else 'RGBA'}" for name, kind in valid.items())


def light_groups_of_layer(layer: bpy.types.ViewLayer) -> tuple[str, ...]:
    """The names of a view layer's light groups."""
    return tuple(layer.lightgroups.keys())


def passes_of_cycles_only(layer: bpy.types.ViewLayer) -> list[str]:
    """Labels of the passes that both have a switch for, of which that of Cycles alone is on."""
    own, cycles = getattr(layer, "rppm", None), getattr(layer, "cycles", None)
    if own is None:
        return []
    return [
        own.bl_rna.properties[name].name
        for of_cycles, name in OF_CYCLES.items()
        if getattr(cycles, of_cycles, False) and not getattr(own, name)
    ]


def passes_of_layer(layer: bpy.types.ViewLayer) -> tuple[RenderPass, ...]:
    """Return the passes that are on in a view layer, in the order of PASSES."""
    levels = layer.pass_cryptomatte_depth
    return tuple(entry for entry in PASSES if entry.level < max(levels, 1) and getattr(*switch_of(layer, entry), False))
