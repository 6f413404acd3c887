# SPDX-License-Identifier: GPL-3.0-or-later
"""RPPM inside Blender: the only floor that imports bpy."""

from . import engine, panels, properties, renderer_process, renderer_thread


def register() -> None:
    """Add the properties, the engine and the panels to Blender."""
    properties.register()
    engine.register()
    panels.register()
    renderer_process.register()


def unregister() -> None:
    """Undo register, end the renderer process and release the graphics device."""
    renderer_process.unregister()
    panels.unregister()
    engine.unregister()
    properties.unregister()
    renderer_thread.release()
