# SPDX-License-Identifier: GPL-3.0-or-later
"""RPPM inside Blender: the only floor that imports bpy."""

from . import engine, panels, properties, renderer_thread


def register() -> None:
    """Add the properties, the engine and the panels to Blender."""
    properties.register()
    engine.register()
    panels.register()


def unregister() -> None:
    """Undo register and release the graphics device."""
    panels.unregister()
    engine.unregister()
    properties.unregister()
    renderer_thread.release()
