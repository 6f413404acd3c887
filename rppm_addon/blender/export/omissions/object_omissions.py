# SPDX-License-Identifier: GPL-3.0-or-later
"""Features that objects use and RPPM does not render as Cycles does."""

import bpy

from .omission import Omission

_CLIPPING = 0.00101
"""Default of Blender's volumes, below which hardly anything is seen, and what single precision adds."""


def _has_velocities(source: bpy.types.Object) -> bool:
    """Return whether an evaluated object is a volume with a grid of velocities, by the names of its grids alone."""
    if source.type != "VOLUME":
        return False
    volume = source.data
    names = {volume.velocity_grid, volume.velocity_x_grid} - {""}
    return volume.grids.load() and any(grid.name in names for grid in volume.grids)


OF_OBJECTS = (
    Omission(
        "Shadow Catcher",
        "light that other objects reflect onto it is left out: shadows next to bright objects are darker",
        ("is_shadow_catcher",),
        lambda source: source.is_shadow_catcher and source.type != "LIGHT",  # whose shadows on catchers it is about
    ),
    Omission(
        "Velocity Grid",
        "its velocities do not blur the volume; it is blurred as its object moves",
        ("data.velocity_grid",),
        _has_velocities,
        counts_in=lambda scene: scene.render.use_motion_blur,
    ),
    Omission(
        "Clipping",
        "voxels of the volume below it are rendered as well",
        ("data.render.clipping",),
        lambda source: source.type == "VOLUME" and source.data.render.clipping > _CLIPPING,
    ),
)
"""By what an evaluated object uses."""
