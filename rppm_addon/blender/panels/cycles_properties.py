# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties that Cycles' add-on gives scenes, objects, lights and worlds, and RPPM renders by.

RPPM has none of its own in their place, so that a file looks alike with both engines. Without the add-on they have
Cycles' defaults, and panels offer to enable it.
"""

import bpy
from bpy.app.translations import pgettext_iface as iface_

ADDON = "cycles"
"""Module of Cycles' add-on."""


def are_there() -> bool:
    """Return whether Cycles' add-on is enabled, in which case scenes have its properties."""
    return hasattr(bpy.types.Scene, "cycles")


def draw_remedy(layout: bpy.types.UILayout, names: str) -> None:
    """Draw what takes the place of properties without the add-on: their names, with commas, and a button."""
    column = layout.column(align=True)
    translated = ", ".join(map(iface_, names.split(", ")))
    column.label(text=iface_("With Cycles' add-on: {}").format(translated), icon="INFO", translate=False)
    button = column.operator("preferences.addon_enable", text="Enable Cycles Render Engine", icon="PLUGIN")
    button.module = ADDON
