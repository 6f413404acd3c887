# SPDX-License-Identifier: GPL-3.0-or-later
"""RPPM inside Blender: the only floor that imports bpy."""

import sys

from ..wheel_libraries import add_wheel_libraries
from . import background, operators, panels, preferences, properties, reports, self_test, user_folder
from .engine import broken_frames, frame_reuse, preparing, render_engine
from .export.images import kept_images
from .render_client import renderer_process, renderer_thread


def register() -> None:
    """Add the properties, the engine, the operators, the panels and the preferences to Blender."""
    add_wheel_libraries(sys.path)
    user_folder.register()
    background.register()
    properties.register()
    render_engine.register()
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
    render_engine.unregister()
    properties.unregister()
    background.unregister()
    user_folder.unregister()
    reports.forget()
    renderer_thread.release()
