# SPDX-License-Identifier: GPL-3.0-or-later
"""RPPM inside Blender: the only floor that imports bpy."""

import sys

from ..wheel_libraries import add_wheel_libraries
from . import (
    background,
    broken_frames,
    engine,
    frame_reuse,
    operators,
    panels,
    preferences,
    preparing,
    properties,
    renderer_process,
    renderer_thread,
    reports,
    self_test,
)
from .export.images import kept_images


def register() -> None:
    """Add the properties, the engine, the operators, the panels and the preferences to Blender."""
    add_wheel_libraries(sys.path)
    background.register()
    properties.register()
    engine.register()
    operators.register()
    self_test.register()
    panels.register()
    preferences.register()
    renderer_process.register()
    preparing.register()
    frame_reuse.register()
    kept_images.register()
    broken_frames.register()


def unregister() -> None:
    """Undo register, end the renderer process and release the graphics device."""
    broken_frames.unregister()
    kept_images.unregister()
    frame_reuse.unregister()
    preparing.unregister()
    renderer_process.unregister()
    preferences.unregister()
    panels.unregister()
    self_test.unregister()
    operators.unregister()
    engine.unregister()
    properties.unregister()
    reports.forget()
    renderer_thread.release()
