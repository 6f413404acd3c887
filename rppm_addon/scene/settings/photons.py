# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of the photons: how many, and the radii within which they count."""

from dataclasses import dataclass

from ..errors import SettingsError
from .group import SettingGroup
from .setting_info import setting

MOST_PHOTONS = 1 << 22
_FEWEST_AUTOMATIC_PHOTONS, _MOST_AUTOMATIC_PHOTONS = 1 << 13, 1 << 18
"""Fewer photons take hardly less time; more take longer than one waits for an iteration where there is no GPU."""


@dataclass
class PhotonSettings(SettingGroup):
    """Photons of an iteration and the radii of Eq. 2 to 4. Lengths in meters."""

    photons: int = setting(
        0,
        "Photons",
        "Photons emitted in each sample, allocated to the lights by their power and photon weight; "
        "0 is automatic: as many as the picture has pixels, within limits, and fewer after the second sample "
        "where they make little of the noise",
        minimum=0,
        maximum=MOST_PHOTONS,
        zero="automatic",
        step=1024,
    )
    """Photons of an iteration; photons_for says how many are automatic."""
    alpha: float = setting(
        0.7,
        "Alpha",
        "Fraction of the new photons that are kept as the radius shrinks: low values sharpen quickly and stay noisy, "
        "high values stay smooth and blurred",
        minimum=0.01,
        maximum=0.999999,
        soft_maximum=0.99,
        unit="fraction",
    )
    """The paper's alpha, Eq. 2."""
    radius_scale: float = setting(
        10.0,
        "Initial Radius",
        "The first sample gathers photons over a disk as large as a square of this side, in pixels of a 1 megapixel "
        "picture; larger and smaller pictures scale it",
        minimum=0.01,
        soft_minimum=1.0,
        soft_maximum=50.0,
        unit="pixels",
    )
    """The paper's s_r, Eq. 3."""
    use_adaptive_radius: bool = setting(
        True,
        "Adaptive Radius",
        "Begin with up to four times the radius for caustics, by how far apart photons are, and come back to the "
        "initial one where they are many: less noise where they are few. Without effect where Minimum Radius "
        "or Maximum Radius is set",
    )
    radius_minimum: float = setting(
        0.0,
        "Minimum Radius",
        "Smallest radius in the first sample, shrinking from there; 0 is automatic",
        minimum=0.0,
        soft_maximum=1.0,
        unit="m",
        zero="automatic",
    )
    """The paper's r_min in the first iteration, meters."""
    radius_maximum: float = setting(
        0.0,
        "Maximum Radius",
        "Largest radius in the first sample, shrinking from there; 0 is automatic",
        minimum=0.0,
        soft_maximum=1.0,
        unit="m",
        zero="automatic",
    )
    """The paper's r_max in the first iteration, meters."""

    def validate(self) -> None:
        """Raise SettingsError for a value out of its range, and where the limits of the radius leave none."""
        super().validate()
        if 0.0 < self.radius_maximum < self.radius_minimum:
            raise SettingsError(
                f"radius_maximum is {self.radius_maximum}, less than radius_minimum {self.radius_minimum}; raise it"
            )

    def photons_for(self, width: int, height: int) -> int:
        """Photons of the first iteration of a picture of ``width`` x ``height`` pixels; automatic: one a pixel within
        limits. Later iterations do not exceed them (integrator/common/photon_counts.py).

        The number is the same on all machines and in all runs.
        """
        if self.photons:
            return self.photons
        return max(min(width * height, _MOST_AUTOMATIC_PHOTONS), _FEWEST_AUTOMATIC_PHOTONS)
