# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's Sky Texture as numbers: radiance by direction, and the sun.

Values are those of Cycles, found and checked in renders (tests/parity/skies/test_sky_values.py).
"""

import numpy as np

from ...scene.common.working_space import REC709, WorkingSpace
from ...scene.sky import SKY_TYPES, Sky
from . import hosek_wilkie as sky_hosek_wilkie
from . import multiple_scattering as sky_multiple_scattering
from . import preetham as sky_preetham
from . import single_scattering as sky_single_scattering
from .sun import SunDisc, sun_disc
from .table import look_up

__all__ = ["SunDisc", "sky_picture", "sky_radiance", "sun_disc"]

_TABLES = {
    "SINGLE_SCATTERING": sky_single_scattering.sky_table,
    "MULTIPLE_SCATTERING": sky_multiple_scattering.sky_table,
}
_FORMULAS = {"PREETHAM": sky_preetham.radiance, "HOSEK_WILKIE": sky_hosek_wilkie.radiance}


def sky_radiance(sky: Sky, directions: np.ndarray, space: WorkingSpace = REC709) -> np.ndarray:
    """(n, 3) float32 radiance in W/(m^2 sr), in a working space, in unit directions (n, 3) with +Z up.

    Without the sun's disk, which ``sun_disc`` gives, and before the strength of the Background node. Raises
    ValueError where the sky's type is unknown.
    """
    if sky.sky_type not in SKY_TYPES:
        raise ValueError(f"unknown type of sky {sky.sky_type!r}; known are {', '.join(SKY_TYPES)}")
    if sky.scatters:
        return look_up(_TABLES[sky.sky_type](sky, space), directions, sky.sun_angles()[1])
    return _FORMULAS[sky.sky_type](sky, directions, space)


def sky_picture(sky: Sky, height: int = 512, space: WorkingSpace = REC709) -> np.ndarray:
    """(height, 2 height, 4) float32 equirectangular pixels as scene.Image and World take them, row 0 looking down.

    Each pixel is the radiance in its middle; the horizon lies between two rows. Without the sun's disk, which would
    be smaller than a pixel: a sun light has to stand in for it.
    """
    azimuth = (0.5 - (np.arange(2 * height) + 0.5) / (2 * height)) * 2.0 * np.pi  # from +X toward +Y
    elevation = (((np.arange(height) + 0.5) / height - 0.5) * np.pi)[:, None]
    along = np.cos(elevation)
    x, y, z = along * np.cos(azimuth), along * np.sin(azimuth), np.sin(elevation) + 0.0 * azimuth
    pixels = np.ones((height, 2 * height, 4), np.float32)
    directions = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    pixels[..., :3] = sky_radiance(sky, directions, space).reshape(height, -1, 3)
    return pixels
