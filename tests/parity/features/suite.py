# SPDX-License-Identifier: GPL-3.0-or-later
"""All rows: importing the families puts them on the list."""

from . import (  # noqa: F401
    ashikhmin_shirley,
    cameras,
    coordinates,
    displacement,
    fibers,
    image_textures,
    light_limits,
    light_linking,
    lights,
    media,
    metallic,
    portals,
    profiles,
    ray_nodes,
    shaders,
    shadow_terminator,
    simplify,
    strands,
    values,
    worlds,
    zones_and_closures,
)
from .rows import ROWS

__all__ = ["ROWS"]
