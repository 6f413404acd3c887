# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators behind the buttons of panels and preferences."""

import contextlib

import bpy
from bpy.app.translations import pgettext_rpt as rpt_
from bpy.props import EnumProperty, StringProperty

from ..session.client.client import ProcessState
from . import colored_glasses, panels
from .render_client import renderer_process
from .subjects import SubjectKind, select

START_SHOWN_EVERY = 0.25
"""Seconds."""
_TABS = {SubjectKind.OBJECT: "OBJECT", SubjectKind.MATERIAL: "MATERIAL", SubjectKind.WORLD: "WORLD"}


class RPPM_OT_select_subject(bpy.types.Operator):
    """Select what the warning is about"""

    bl_idname = "rppm.select_subject"
    bl_label = "Select"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    kind: EnumProperty(
        name="Kind",
        description="What kind of thing is to be selected",
        items=[(kind.name, kind.name.capitalize(), "", kind.value) for kind in SubjectKind],
    )
    name: StringProperty(name="Name", description="Name of the object, material or world")
    node: StringProperty(name="Node", description="Name of the node that becomes the active one")

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Called by Blender."""
        if context.mode != "OBJECT" and bpy.ops.object.mode_set.poll():
            bpy.ops.object.mode_set(mode="OBJECT")
        kind = SubjectKind[self.kind]
        problem = select(context, kind, self.name, self.node)
        if problem:
            self.report({"WARNING"}, problem[0].upper() + problem[1:])
        space = context.space_data
        if space is not None and space.type == "PROPERTIES" and not problem:
            # Refused where the editor has not yet seen that the active object has such a tab.
            with contextlib.suppress(TypeError):
                space.context = _TABS[kind]
        return {"FINISHED"}


class RPPM_OT_start_renderer(bpy.types.Operator):
    """Start the renderer process, anew if it runs, and see which graphics device it finds"""

    bl_idname = "rppm.start_renderer"
    bl_label = "Restart the Renderer"
    bl_options = {"INTERNAL"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Called by Blender."""
        renderer_process.renderer_process().restart(lists_devices=True)
        if not bpy.app.timers.is_registered(_show_start):
            bpy.app.timers.register(_show_start, first_interval=START_SHOWN_EVERY)
        return {"FINISHED"}


def _show_start() -> float | None:
    """Have the preferences drawn again until the process has started or failed and has listed the devices."""
    panels.redraw()
    process = renderer_process.renderer_process()
    return START_SHOWN_EVERY if process.state is ProcessState.STARTING or process.is_listing else None


class RPPM_OT_open_log(bpy.types.Operator):
    """Open the renderer's log file with the program that shows text files"""

    bl_idname = "rppm.open_log"
    bl_label = "Open the Log"
    bl_options = {"INTERNAL"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Called by Blender."""
        path = renderer_process.renderer_process().log_path
        if not path.is_file():
            template = rpt_("There is no log yet: {} is written once the renderer has started")
            self.report({"WARNING"}, template.format(path))
            return {"CANCELLED"}
        bpy.ops.wm.path_open(filepath=str(path))
        return {"FINISHED"}


class RPPM_OT_convert_to_dispersion(bpy.types.Operator):
    """Replace red, green and blue glass that are added by one glass with dispersion, of the same indices"""

    bl_idname = "rppm.convert_to_dispersion"
    bl_label = "Convert to Dispersion"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Called by Blender."""
        material = getattr(context, "material", None)
        return material is not None and material.library is None and material.override_library is None

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Called by Blender."""
        material = context.material
        found = colored_glasses.colored_glasses(material)
        if found is None:
            template = rpt_('"{}" has no red, green and blue glass that are added')
            self.report({"WARNING"}, template.format(material.name))
            return {"CANCELLED"}
        ior, abbe_number = found.fitted
        colored_glasses.convert(material, found)
        template = rpt_('"{}": one glass, IOR {:.3f}, Abbe Number {:.1f}')
        text = template.format(material.name, ior, material.rppm.abbe_number)
        if abbe_number < 0.0:
            template = rpt_("{}; red had the largest index, which no glass has: blue has it now")
            self.report({"WARNING"}, template.format(text))
        else:
            self.report({"INFO"}, text)
        return {"FINISHED"}


_CLASSES = (RPPM_OT_select_subject, RPPM_OT_start_renderer, RPPM_OT_open_log, RPPM_OT_convert_to_dispersion)


def register() -> None:
    """Add the operators."""
    for cls in _CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    """Take out the operators."""
    if bpy.app.timers.is_registered(_show_start):
        bpy.app.timers.unregister(_show_start)
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
