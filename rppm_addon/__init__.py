# SPDX-License-Identifier: GPL-3.0-or-later
"""RPPM: progressive photon mapping by rasterization.

Blender calls register and unregister; without Blender the floors below ``blender`` are used alone.
"""


def register() -> None:
    """Add the engine, its properties and its panels to Blender."""
    from .blender import register

    register()


def unregister() -> None:
    """Take everything out of Blender again and release the graphics device."""
    from .blender import unregister

    unregister()
