# SPDX-License-Identifier: GPL-3.0-or-later
"""Parameters of a sky; rppm_addon.materials.sky.picture computes its radiance."""

import math
from dataclasses import dataclass

import numpy as np

SKY_TYPES = ("SINGLE_SCATTERING", "MULTIPLE_SCATTERING", "PREETHAM", "HOSEK_WILKIE")
"""Blender 5's names. What Blender 4 calls NISHITA is SINGLE_SCATTERING."""


@dataclass(frozen=True)
class Sky:
    """Blender's Sky Texture; names and defaults are those of its node in Blender 5."""

    sky_type: str = "MULTIPLE_SCATTERING"
    sun_elevation: float = math.radians(15.0)
    """Angle of the sun above the horizon, radians; scattering types only, as all up to ozone_density."""
    sun_rotation: float = 0.0
    """Angle from +Y toward +X, radians."""
    sun_disc: bool = True
    """Whether the sun itself is seen."""
    sun_size: float = math.radians(0.545)
    """Full angle under which the disk is seen, radians; the sun's irradiance does not depend on it."""
    sun_intensity: float = 1.0
    """Factor of the disk's radiance; the sky's light stays as it is."""
    altitude: float = 100.0
    """Height of the viewer above the sea, meters."""
    air_density: float = 1.0
    """Density of air molecules as a fraction of the Earth's."""
    aerosol_density: float = 1.0
    """Density of dust, pollution and droplets as a fraction of a city's (Blender 4: dust_density)."""
    ozone_density: float = 1.0
    """Density of the ozone layer as a fraction of the Earth's."""
    sun_direction: tuple[float, float, float] = (0.0, 0.0, 1.0)
    """To the sun; PREETHAM and HOSEK_WILKIE only, as the following."""
    turbidity: float = 2.2
    """1 is clear air, 10 is haze."""
    ground_albedo: float = 0.3
    """HOSEK_WILKIE only."""

    @property
    def scatters(self) -> bool:
        """Whether the atmosphere is simulated, with a sun that is part of the sky."""
        return self.sky_type in ("SINGLE_SCATTERING", "MULTIPLE_SCATTERING")

    def sun_angles(self) -> tuple[float, float]:
        """Elevation within a quarter turn of the horizon and rotation that mean the same, radians."""
        elevation = math.remainder(self.sun_elevation, 2.0 * math.pi)
        if abs(elevation) <= math.pi / 2:
            return elevation, self.sun_rotation
        return math.copysign(math.pi, elevation) - elevation, self.sun_rotation + math.pi

    def direction_to_sun(self) -> np.ndarray:
        """(3,) float64 unit vector."""
        if not self.scatters:
            direction = np.array(self.sun_direction, np.float64)
            length = np.linalg.norm(direction)
            return direction / length if length > 0.0 else np.array([0.0, 0.0, 1.0])
        horizontal = math.cos(self.sun_elevation)
        return np.array(
            [
                math.sin(self.sun_rotation) * horizontal,
                math.cos(self.sun_rotation) * horizontal,
                math.sin(self.sun_elevation),
            ]
        )
