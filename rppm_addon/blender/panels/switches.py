# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings for which 0 is automatic or no limit: a switch says so in words, and shows the value where there is one."""

import bpy
from bpy.app.translations import pgettext_iface as iface_

from ...scene import RenderSettings
from ...scene.settings.setting_info import settings_of
from ..properties import VIEWPORT_APART, VIEWPORT_PHOTONS, viewport_property

_MEANINGS = {name: info.zero.capitalize() for name, info in settings_of(RenderSettings).items()}
MEANINGS = (
    {info.property_of(name): _MEANINGS[name] for name, info in settings_of(RenderSettings).items()}
    | {viewport_property(name): _MEANINGS[name] for name in VIEWPORT_APART}
    | {"preview_photons": _MEANINGS["photons"]}
)
"""By property of scene.rppm, what its 0 stands for."""
SUGGESTIONS = {
    "adaptive_min_samples": 64,
    "preview_adaptive_min_samples": 32,
    "time_limit": 60.0,
    "photons": 1 << 16,
    "preview_photons": VIEWPORT_PHOTONS,
    "radius_minimum": 0.001,
    "radius_maximum": 0.01,
    "cubemap_resolution": 512,
}
"""Values that a switch sets in place of 0, by property of scene.rppm, in the units of the settings."""


def _switch(name: str) -> object:
    def is_on(owner: bpy.types.PropertyGroup) -> bool:
        return getattr(owner.id_data.rppm, name) != 0

    def switch(owner: bpy.types.PropertyGroup, on: bool) -> None:
        if on != is_on(owner):
            setattr(owner.id_data.rppm, name, SUGGESTIONS[name] if on else 0)

    description = f"{MEANINGS[name]} while this is off"
    return bpy.props.BoolProperty(name=f"Set {name}", description=description, get=is_on, set=switch)


class RppmSwitches(bpy.types.PropertyGroup):
    """Whether settings are other than 0; nothing of its own is stored."""

    __annotations__ = {name: _switch(name) for name in SUGGESTIONS}


def draw_setting(column: bpy.types.UILayout, scene: bpy.types.Scene, name: str, text: str, unset: str = "") -> None:
    """A setting of SUGGESTIONS with its switch.

    unset: text shown instead of the value 0, by default what it stands for.
    """
    row = column.row(heading=text)
    row.prop(scene.rppm_switches, name, text="")
    if getattr(scene.rppm, name) != 0:
        row.prop(scene.rppm, name, text="")
    else:
        row.label(text=unset or iface_(MEANINGS[name]), translate=False)


def register() -> None:
    """Give scenes the switches."""
    bpy.utils.register_class(RppmSwitches)
    bpy.types.Scene.rppm_switches = bpy.props.PointerProperty(type=RppmSwitches)


def unregister() -> None:
    """Take them away again."""
    del bpy.types.Scene.rppm_switches
    bpy.utils.unregister_class(RppmSwitches)
