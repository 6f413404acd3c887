# SPDX-License-Identifier: GPL-3.0-or-later
"""The description of a feature that RPPM does not render as Cycles does."""

from collections.abc import Callable
from dataclasses import dataclass

import bpy


@dataclass(frozen=True)
class Omission:
    """Something that Cycles renders and RPPM does not, or does in another way."""

    title: str
    """As Blender's panels have it."""
    consequence: str
    """Consequence: what the picture shows instead, and the remedy where there is one."""
    reads: tuple[str, ...]
    """Paths of the properties that say whether it is used, from the block on."""
    is_used: Callable[[bpy.types.ID], bool]
    """By an evaluated object, or by a scene."""


def of_cycles(block: bpy.types.bpy_struct, name: str, default: object) -> object:
    """A property of Cycles', which may be switched off, or have none of that name in this version."""
    return getattr(getattr(block, "cycles", None), name, default)
