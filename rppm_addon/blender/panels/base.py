# SPDX-License-Identifier: GPL-3.0-or-later
"""Base class and layout functions that all panels of RPPM in the Properties editor share."""

import textwrap
from typing import ClassVar

import bpy
from bpy.app.translations import pgettext_iface as iface_

from ...scene.errors import SceneError
from ..export.camera.camera import crop, frame_size

ENGINE = "RPPM"
_CHARACTER_WIDTH = 7.0
"""Pixels of a letter at a scale of 1, on average."""


class EnginePanel:
    """Mixed into panels that show for some render engines."""

    COMPAT_ENGINES: ClassVar[set[str]]
    """Engines for which the panel shows. Each class has a set of its own, which other add-ons may add theirs to."""

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        cls.COMPAT_ENGINES = {ENGINE}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.engine in cls.COMPAT_ENGINES


class RppmPanel(EnginePanel):
    """Mixed into panels of the render tab; others set ``bl_context``."""

    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"
    is_decorated = False
    """Whether what can be animated has its dot, as in Blender's own panels of objects' data."""

    def column(self) -> bpy.types.UILayout:
        """A column laid out as Blender's own panels are."""
        self.layout.use_property_split = True
        self.layout.use_property_decorate = self.is_decorated
        return self.layout.column()


def rendered_size(render: bpy.types.RenderSettings) -> tuple[int, int]:
    """Pixels across and upward that a final render has."""
    width, height = frame_size(render)
    try:
        region = crop(render, width, height)
    except SceneError:  # an empty border, which a render says
        region = None
    return (width, height) if region is None else (region[2] - region[0], region[3] - region[1])


def length_text(scene: bpy.types.Scene, length: float) -> str:
    """A length of Blender's units in the units that the scene shows, with three digits."""
    units = scene.unit_settings
    if units.system == "NONE":
        return iface_("{:.3g} units").format(length)
    return bpy.utils.units.to_string(units.system, "LENGTH", units.scale_length * length, precision=3).strip()


def letters_across(context: bpy.types.Context) -> int:
    """How many letters one line of the region takes beside what Blender leaves free or puts there."""
    scale = context.preferences.system.ui_scale
    return max(20, int(context.region.width / (_CHARACTER_WIDTH * scale)) - 8)


def reading(layout: bpy.types.UILayout, name: str, text: str) -> None:
    """A line with a figure that is computed, laid out as a property is. Blender translates the name alone."""
    split = layout.split(factor=0.4)
    left = split.row()
    left.alignment = "RIGHT"
    left.label(text=name)
    split.label(text=text, translate=False)


def restart_button(layout: bpy.types.UILayout) -> None:
    """Draw the button that starts a renderer that has stopped."""
    layout.operator("rppm.start_renderer", text="Restart", icon="FILE_REFRESH")


def paragraph(
    layout: bpy.types.UILayout, text: str, letters: int, icon: str = "NONE", most_lines: int | None = None
) -> None:
    """Text in the user's language, on as many lines as it takes with so many letters each, or cut to ``most_lines``."""
    column = layout.column(align=True)
    lines = textwrap.wrap(text, letters, max_lines=most_lines, placeholder=" ...")
    for number, line in enumerate(lines):
        shown = icon if number == 0 else "BLANK1" if icon != "NONE" else "NONE"
        column.label(text=line, icon=shown, translate=False)
