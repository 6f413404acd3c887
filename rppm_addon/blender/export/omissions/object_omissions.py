# SPDX-License-Identifier: GPL-3.0-or-later
"""Features that objects use and RPPM does not render as Cycles does."""

from ..geometry.meshes.dicing import adaptive_modifier
from .omission import Omission

OF_OBJECTS = (
    Omission(
        "Adaptive Subdivision",
        "what is displaced is divided evenly, into a million triangles at most; other surfaces are as their modifiers "
        "have them for renders",
        ("cycles.use_adaptive_subdivision", "modifiers"),
        lambda source: adaptive_modifier(source) is not None,
    ),
)
"""By what an evaluated object uses."""
