# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties that Cycles' add-on gives scenes, objects, lights and worlds, and RPPM renders by.

RPPM has none of its own in their place, so that a file looks alike with both engines. Without the add-on they have
Cycles' defaults, and panels offer to enable it.
"""

import bpy

ADDON = "cycles"
"""Module of Cycles' add-on."""


def are_there() -> bool:
    """Whether Cycles' add-on is enabled, so that scenes have its properties."""
    return hasattr(bpy.types.Scene, "cycles")


def draw_remedy(layout: bpy.types.UILayout, names: str) -> None:
    """Draw what takes the place of properties without the add-on: their names, and a button that enables it."""
    column = layout.column(align=True)
    column.label(text=f"With Cycles' add-on: {names}", icon="INFO")
    button = column.operator("preferences.addon_enable", text="Enable Cycles Render Engine", icon="PLUGIN")
    button.module = ADDON
