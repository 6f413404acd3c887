# SPDX-License-Identifier: GPL-3.0-or-later
"""RPPM: progressive photon mapping by rasterization.

Blender calls register and unregister; without Blender the layers below ``blender`` are used alone.
"""

import sys


def register() -> None:
    """Add the engine, its properties and its panels to Blender.

    Raises DeviceError on macOS, whose OpenGL is too old.
    """
    if sys.platform == "darwin":
        from .scene.errors import DeviceError

        raise DeviceError("RPPM needs OpenGL 4.3 and macOS stops at 4.1: use Blender on Linux or Windows")
    from .blender import register

    register()


def unregister() -> None:
    """Take everything out of Blender again and release the graphics device."""
    from .blender import unregister

    unregister()
