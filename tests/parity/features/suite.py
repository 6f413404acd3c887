# SPDX-License-Identifier: GPL-3.0-or-later
"""All rows: importing the families puts them on the list."""

from . import cameras, coordinates, image_textures, light_linking, lights, profiles, shaders, values, worlds  # noqa: F401
from .rows import ROWS

__all__ = ["ROWS"]
