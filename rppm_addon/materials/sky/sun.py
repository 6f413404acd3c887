# SPDX-License-Identifier: GPL-3.0-or-later
"""The sun's disk in a simulated sky, with the radiance that Cycles gives it."""

from dataclasses import dataclass

import numpy as np

from ...scene.common.working_space import REC709, WorkingSpace
from ...scene.sky import Sky
from . import multiple_scattering as sky_multiple_scattering
from . import single_scattering as sky_single_scattering

LIMB_DARKENING = 0.6
"""How much darker than its middle the disk's edge is."""
SMALLEST = 0.0005
"""Cycles' smallest full angle, radians."""


@dataclass(frozen=True)
class SunDisc:
    """A disk in the sky. Its light comes on top of the sky's."""

    direction: np.ndarray
    """(3,) float64 unit vector to the middle."""
    angle: float
    """Full angle, radians."""
    bottom: np.ndarray
    """(3,) float64 radiance at the lower edge, limb darkening apart; between it is linear in elevation."""
    top: np.ndarray
    """(3,) float64 at the upper edge."""
    horizon: float
    """Elevation in radians below which the Earth hides the disk."""

    def radiance(self, directions: np.ndarray) -> np.ndarray:
        """(n, 3) float32 in unit directions (n, 3); zero beside the disk."""
        directions = np.asarray(directions, np.float64)
        from_middle = 2.0 * np.arcsin(np.minimum(0.5 * np.linalg.norm(directions - self.direction, axis=1), 1.0))
        elevation = np.arcsin(np.clip(directions[:, 2], -1.0, 1.0))
        fraction = from_middle / (0.5 * self.angle)
        seen = (fraction < 1.0) & (elevation > self.horizon)
        limb = 1.0 - LIMB_DARKENING * (1.0 - np.sqrt(np.maximum(1.0 - fraction**2, 0.0)))
        height = (elevation - np.arcsin(self.direction[2])) / self.angle + 0.5
        color = self.bottom + height[:, None] * (self.top - self.bottom)
        return np.where(seen[:, None], limb[:, None] * np.maximum(color, 0.0), 0.0).astype(np.float32)

    def irradiance(self, rings: int = 32, sectors: int = 128) -> np.ndarray:
        """(3,) float64 irradiance on a surface that faces the disk, W/m^2: the strength of a sun light that
        stands in for it. The midpoint rule over so many rings of equal area and sectors; cosines count as 1."""
        radius = 0.5 * self.angle * np.sqrt((np.arange(rings) + 0.5) / rings)
        around = 2.0 * np.pi * (np.arange(sectors) + 0.5) / sectors
        side = np.cross(self.direction, [0.0, 0.0, 1.0])
        length = np.linalg.norm(side)
        side = side / length if length > 1e-9 else np.array([1.0, 0.0, 0.0])
        upward = np.cross(side, self.direction)
        circle = np.cos(around)[:, None] * side + np.sin(around)[:, None] * upward
        directions = np.cos(radius)[:, None, None] * self.direction + np.sin(radius)[:, None, None] * circle
        solid_angle = 2.0 * np.pi * (1.0 - np.cos(0.5 * self.angle))
        return solid_angle * self.radiance(directions.reshape(-1, 3)).astype(np.float64).mean(axis=0)


def sun_disc(sky: Sky, space: WorkingSpace = REC709) -> SunDisc | None:
    """The disk of a sky whose type has one; None where it is switched off or the Earth hides it."""
    if not sky.scatters or not sky.sun_disc or sky.sun_intensity <= 0.0:
        return None
    angle = max(sky.sun_size, SMALLEST)
    single = sky.sky_type == "SINGLE_SCATTERING"
    model = sky_single_scattering if single else sky_multiple_scattering
    direction = sky.direction_to_sun()
    elevation = np.arcsin(direction[2])
    below, above = elevation - 0.5 * angle, elevation + 0.5 * angle
    horizon = -np.arccos(model.EARTH_RADIUS / model.viewer_radius(sky))
    if above <= (max(horizon, 0.0) if single else horizon):
        return None
    if single:  # Cycles does not look at the sun below 0 there, but lets the disk hang over the edge.
        below = max(below, 0.0)
    # Cycles' single precision, which makes the usual sun 0.1 % darker.
    solid_angle = 2.0 * np.pi * float(np.float32(1.0) - np.cos(np.float32(angle) / np.float32(2.0)))
    scale = sky.sun_intensity / solid_angle
    return SunDisc(
        direction,
        angle,
        scale * space.from_rec709(model.sun_irradiance(sky, below)),
        scale * space.from_rec709(model.sun_irradiance(sky, above)),
        float(horizon),
    )
