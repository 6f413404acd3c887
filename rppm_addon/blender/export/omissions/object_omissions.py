# SPDX-License-Identifier: GPL-3.0-or-later
"""Features that objects use and RPPM does not render as Cycles does."""

from .omission import Omission

_CLIPPING = 0.00101
"""Default of Blender's volumes, below which hardly anything is seen, and what single precision adds."""


OF_OBJECTS = (
    Omission(
        "Shadow Catcher",
        "light that other objects reflect onto it is left out: shadows next to bright objects are darker",
        ("is_shadow_catcher",),
        lambda source: source.is_shadow_catcher and source.type != "LIGHT",  # whose shadows on catchers it is about
    ),
    Omission(
        "Clipping",
        "voxels of the volume below it are rendered as well",
        ("data.render.clipping",),
        lambda source: source.type == "VOLUME" and source.data.render.clipping > _CLIPPING,
    ),
)
"""By what an evaluated object uses."""
