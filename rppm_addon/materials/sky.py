# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's Sky Texture as numbers: radiance by direction, and the sun.

Values are those of Cycles, measured in renders (tests/parity/test_sky_values.py), but for HOSEK_WILKIE: its nine
coefficients come from tables of a fit to path-traced skies (Hosek and Wilkie 2012), which are not part of RPPM. The
sky of Preetham stands in; ``stands_in`` tells, and the exporter has to warn.
"""

import numpy as np

from ..scene.sky import SKY_TYPES, Sky
from . import sky_multiple_scattering, sky_preetham, sky_single_scattering
from .sky_sun import SunDisc, sun_disc
from .sky_table import look_up

__all__ = ["HOSEK_WILKIE_SHARE", "SunDisc", "sky_picture", "sky_radiance", "stands_in", "sun_disc"]

HOSEK_WILKIE_SHARE = 0.23
"""What share of Preetham's sky stands in for that of Hosek and Wilkie, of which Cycles makes a darker one."""


def stands_in(sky: Sky) -> bool:
    """Whether sky_radiance gives another model than the one asked for."""
    return sky.sky_type == "HOSEK_WILKIE"


def sky_radiance(sky: Sky, directions: np.ndarray) -> np.ndarray:
    """(n, 3) float32 radiance in W/(m^2 sr), linear Rec.709, in unit directions (n, 3) with +Z up.

    Without the sun's disc, which ``sun_disc`` gives, and before the strength of the Background node. Raises
    ValueError where the sky's type is unknown.
    """
    if sky.sky_type not in SKY_TYPES:
        raise ValueError(f"unknown type of sky {sky.sky_type!r}; known are {', '.join(SKY_TYPES)}")
    directions = np.asarray(directions)
    if not sky.scatters:
        radiance = sky_preetham.radiance(sky, directions)
        return radiance * np.float32(HOSEK_WILKIE_SHARE) if stands_in(sky) else radiance
    model = sky_single_scattering if sky.sky_type == "SINGLE_SCATTERING" else sky_multiple_scattering
    return look_up(model.sky_table(sky), directions, sky.sun_angles()[1])


def sky_picture(sky: Sky, height: int = 256) -> np.ndarray:
    """(height, 2 height, 4) float32 equirectangular pixels as scene.Image and World take them, row 0 looking down.

    Each pixel is the radiance in its middle; the horizon lies between two rows. Without the sun's disc, which would
    be smaller than a pixel: a sun light has to stand in for it.
    """
    azimuth = (0.5 - (np.arange(2 * height) + 0.5) / (2 * height)) * 2.0 * np.pi  # from +X towards +Y
    elevation = (((np.arange(height) + 0.5) / height - 0.5) * np.pi)[:, None]
    along = np.cos(elevation)
    x, y, z = along * np.cos(azimuth), along * np.sin(azimuth), np.sin(elevation) + 0.0 * azimuth
    pixels = np.ones((height, 2 * height, 4), np.float32)
    pixels[..., :3] = sky_radiance(sky, np.stack([x, y, z], axis=-1).reshape(-1, 3)).reshape(height, -1, 3)
    return pixels
