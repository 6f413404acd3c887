# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension's preferences: the renderer process, the graphics device that it found, and what is missing."""

import importlib.util
import sys
from typing import TYPE_CHECKING

import bpy
from bpy.app.translations import pgettext_iface as iface_
from bpy.app.translations import pgettext_tip as tip_

from ..denoising.places import REMEDY
from ..scene.common.quantities import bytes_text
from ..session.client.client import ProcessState
from . import self_test
from .panels.base import letters_across, paragraph, reading
from .render_client import renderer_process
from .render_client.chosen_device import ChosenDevice, device_here, device_of_environment, with_device_here
from .render_client.denoising_libraries import denoising_libraries, root_package

if TYPE_CHECKING:
    from ..gl.context.context import DeviceInformation

_MODULES = ("numpy", "moderngl", "glcontext")
"""Modules that the renderer process imports besides this package."""
_TEXTS = {
    ProcessState.STOPPED: "The renderer has not been needed yet",
    ProcessState.STARTING: "The renderer is starting",
    ProcessState.RUNNING: "The renderer is running",
    ProcessState.FAILED: "The renderer does not run",
}
_LIMITS = {
    "GL_MAX_SHADER_STORAGE_BLOCK_SIZE": "Largest Buffer",
    "GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS": "Buffers of a Program",
    "GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS": "Threads of a Group",
    "GL_MAX_TEXTURE_SIZE": "Texture Size",
}


_AUTOMATIC = "AUTOMATIC"
_items: list[tuple[str, str, str, int]] = []
"""Items of the menu of devices, kept here because Blender does not keep their texts."""


def _device_items(owner: bpy.types.AddonPreferences, _context: bpy.types.Context | None) -> list:
    """RPPM's choice, the devices that the renderer has found, and the chosen one where it is none of them."""
    device = renderer_process.renderer_process().device
    labels: dict[str, str] = {}
    for found in device.devices if device is not None else ():
        labels.setdefault(found.identity, found.label)  # a card that two drivers list is one
    chosen = device_here(owner.devices)
    if chosen is not None:
        template = iface_("{}, not looked for yet") if device is None else iface_("{}, not there")
        labels.setdefault(chosen.identity, template.format(chosen.name))
    automatic = tip_("A graphics card; where there is none what the processor has, and at last the processor itself")
    _items[:] = [
        (_AUTOMATIC, iface_("Automatic"), automatic, 0),
        *((identity, label, identity, number) for number, (identity, label) in enumerate(labels.items(), 1)),
    ]
    return _items


def _device_of(owner: bpy.types.AddonPreferences) -> int:
    chosen = device_here(owner.devices)
    items = _device_items(owner, None)
    return 0 if chosen is None else next(number for identity, _, _, number in items if identity == chosen.identity)


def _choose_device(owner: bpy.types.AddonPreferences, number: int) -> None:
    identity, label, _, _ = _device_items(owner, None)[number]
    before = device_here(owner.devices)
    if number and before is not None and before.identity == identity:
        return
    chosen = ChosenDevice(identity, label.partition(" (")[0]) if number else None
    owner.devices = with_device_here(owner.devices, chosen)
    renderer_process.device_changed()


def missing() -> list[str]:
    """List what keeps RPPM from rendering here, a line each with the remedy."""
    problems = []
    if sys.platform == "darwin":
        problems.append(iface_("macOS stops at OpenGL 4.1 and RPPM needs 4.3: use Linux or Windows"))
    # Looked for without importing them: Windows cannot replace what Blender has loaded.
    modules = [name for name in _MODULES if importlib.util.find_spec(name) is None]
    if modules:
        template = iface_("Python does not find {}: install the extension's zip for this platform again")
        problems.append(template.format(", ".join(modules)))
    return problems


class RppmPreferences(bpy.types.AddonPreferences):
    """Preferences that hold for all files of a user."""

    bl_idname = root_package()

    devices: bpy.props.StringProperty(
        name="Devices", description="The chosen device by the machine's name, as JSON", options={"HIDDEN"}
    )
    device: bpy.props.EnumProperty(
        name="Device",
        description="The graphics device that this machine renders on; others that share these preferences have theirs",
        items=_device_items,
        get=_device_of,
        set=_choose_device,
    )
    denoiser_path: bpy.props.StringProperty(
        name="Denoiser",
        description=(
            "The file of an Open Image Denoise library of version 2, for a Blender that brings none and where the "
            "package pyoidn is not installed"
        ),
        subtype="FILE_PATH",
        update=lambda _owner, _context: renderer_process.libraries_changed(),
    )

    def draw(self, context: bpy.types.Context) -> None:
        """Called by Blender."""
        layout = self.layout
        problems = missing()
        for problem in problems:
            paragraph(layout, problem, letters_across(context), icon="ERROR")
        if problems:
            return
        process = renderer_process.renderer_process()
        state = process.state
        row = layout.row()
        row.label(text=_TEXTS[state], icon="ERROR" if state is ProcessState.FAILED else "NONE")
        row.operator("rppm.start_renderer", text="Check the Device" if state is ProcessState.STOPPED else "Restart")
        if process.error:
            paragraph(layout, process.error, letters_across(context), icon="INFO")
        device = process.device  # the process may end meanwhile
        if device is not None:
            self._draw_device(device, context)
        if device_of_environment():
            template = iface_("{}, by the environment variable RPPM_DEVICE or --rppm-device")
            reading(layout, "Chosen Device", template.format(device_of_environment()))
        elif sys.platform.startswith("linux"):
            split = layout.split(factor=0.4)
            left = split.row()
            left.alignment = "RIGHT"
            left.label(text="Device")
            split.prop(self, "device", text="")
        self._draw_denoiser(context)
        row = layout.row()
        row.label(text=iface_("Log: {}").format(process.log_path), translate=False)
        row.operator("rppm.open_log", text="Open", icon="TEXT")
        self_test.draw(layout)

    def _draw_denoiser(self, context: bpy.types.Context) -> None:
        column = self.layout.column(align=True)
        libraries = denoising_libraries()
        if libraries:
            used = libraries[0]
            reading(column, "Open Image Denoise", iface_("of {}: {}").format(used.source.value, used.path))
        else:
            text = iface_("Open Image Denoise is not there: {}").format(iface_(REMEDY))
            paragraph(column, text, letters_across(context), icon="INFO")
        column.prop(self, "denoiser_path", text="Denoiser")

    def _draw_device(self, device: "DeviceInformation", context: bpy.types.Context) -> None:
        column = self.layout.column(align=True)
        reading(column, "Renders on", device.name)
        for warning in device.warnings:
            paragraph(column, warning, letters_across(context), icon="ERROR")
        reading(column, "Driver", device.driver)
        if device.driver_folder:
            reading(column, "Driver Folder", device.driver_folder)
        reading(column, "OpenGL", device.version)
        for name, text in _LIMITS.items():
            if name in device.limits:
                limit = int(device.limits[name])
                reading(column, text, bytes_text(limit) if name.endswith("_BLOCK_SIZE") else f"{limit:,}")
        for text in device.missing:
            reading(column, "Without", text)


def register() -> None:
    """Add the preferences."""
    bpy.utils.register_class(RppmPreferences)


def unregister() -> None:
    """Take out the preferences."""
    bpy.utils.unregister_class(RppmPreferences)
