# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of the Properties editor."""

import bpy

from . import borrowed, data, render

_CLASSES = (*render.CLASSES, *data.CLASSES)


def register() -> None:
    for cls in _CLASSES:
        bpy.utils.register_class(cls)
    borrowed.register()


def unregister() -> None:
    borrowed.unregister()
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
