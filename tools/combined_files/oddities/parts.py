# SPDX-License-Identifier: GPL-3.0-or-later
"""The list of the parts, and materials that they share."""

from collections.abc import Callable
from typing import Any

import bpy

from ..draws import Draws
from ..graphs import finish, material
from ..scenes import Place

PARTS: dict[str, Callable[[Draws, Place], None]] = {}
"""Functions that place something near a point on the ground, no wider than a meter, by name."""


def part(make: Callable[[Draws, Place], None]) -> Callable[[Draws, Place], None]:
    """Put a part on the list, by the name of its function."""
    PARTS[make.__name__] = make
    return make


def matte(color: Any, name: str = "Matte") -> bpy.types.Material:
    """A diffuse material of an RGBA color or of a socket."""
    made, graph = material(name)
    finish(graph, graph.node("BsdfDiffuse", Color=color))
    return made
