# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of light paths: how long they are, and how light is estimated at their vertices."""

import enum
from dataclasses import dataclass

from .group import SettingGroup
from .setting_info import setting

_MOST_BOUNCES = 1024
MOST_SEGMENTS = 1024
"""Most rays of a path: as many as a photon's record can distinguish."""
MOST_COUNTED_BOUNCES = 255
"""Largest number of bounces of a type that paths count."""
NO_BOUNCE_LIMIT = 0xFFFFFFFF
_MOST_PASSED = 32
"""Most segments through surfaces that a path does not see, such as objects hidden from the camera; no limit counts
them."""


class DirectLight(enum.Enum):
    """Estimator of the light that comes straight from a source; never both."""

    RAYS = "RAYS"
    PHOTONS = "PHOTONS"


@dataclass
class LightPathSettings(SettingGroup):
    """Bounces of camera paths and photons, and the estimators at their vertices."""

    max_bounces: int = setting(
        32,
        "Max Bounces",
        "Most bounces of light on its way from what it lights first to the camera, as Cycles counts them: those of "
        "photons, of the final gather and of camera rays together. 0 is direct light only",
        minimum=0,
        maximum=_MOST_BOUNCES,
        soft_maximum=64,
    )
    diffuse_bounces: int = setting(
        _MOST_BOUNCES,
        "Diffuse Bounces",
        "Most times that light may be scattered by diffuse reflection on its way from what it lights first to the "
        "camera, as Cycles counts them; from 255 on there is no limit",
        minimum=0,
        maximum=_MOST_BOUNCES,
        soft_maximum=64,
    )
    glossy_bounces: int = setting(
        _MOST_BOUNCES,
        "Glossy Bounces",
        "Most times that light may be scattered by glossy reflection and mirrors on its way from what it lights first "
        "to the camera, as Cycles counts them; from 255 on there is no limit",
        minimum=0,
        maximum=_MOST_BOUNCES,
        soft_maximum=64,
    )
    transmission_bounces: int = setting(
        _MOST_BOUNCES,
        "Transmission Bounces",
        "Most times that light may pass glass and translucent surfaces on its way from what it lights first to the "
        "camera, as Cycles counts them; from 255 on there is no limit",
        minimum=0,
        maximum=_MOST_BOUNCES,
        soft_maximum=64,
    )
    transparent_max_bounces: int = setting(
        8,
        "Transparent Max Bounces",
        "Most transparent surfaces that light passes on its way to the camera, which are no bounces",
        minimum=0,
        maximum=_MOST_BOUNCES,
        soft_maximum=64,
    )
    """The name and the default are those of Cycles."""
    volume_bounces: int = setting(
        0,
        "Volume Bounces",
        "Most times that light is scattered within volumes after the first, which Max Bounces limits as well. 0 is "
        "single scattering; from 31 on there is no other limit",
        minimum=0,
        maximum=_MOST_BOUNCES,
        soft_maximum=64,
    )
    """The name and the default are those of Cycles."""
    camera_path_length: int = setting(
        1 + _MOST_BOUNCES,
        "Max Camera Bounces",
        "Most bounces of camera rays and of the final gather, which Max Bounces limits as well; behind the last one "
        "rays see what shines and nothing else",
        property_name="max_camera_bounces",
        property_offset=-1,
        minimum=1,
        maximum=1 + _MOST_BOUNCES,
        soft_maximum=64,
    )
    """d_eye: camera path segments that may leave importons, the primary ray being the first."""
    photon_path_length: int = setting(
        1 + _MOST_BOUNCES,
        "Max Photon Bounces",
        "Most bounces of photons off any surface, which Max Bounces limits as well",
        property_name="max_photon_bounces",
        property_offset=-1,
        minimum=1,
        maximum=1 + _MOST_BOUNCES,
        soft_maximum=64,
    )
    """d_photon: photon path segments, the first leaving the light; transparent surfaces do not count."""
    specular_roughness: float = setting(
        0.5,
        "Specular Roughness",
        "Surfaces up to this roughness, as their node shows it, are followed as mirrors and glass; rougher ones "
        "gather photons",
        minimum=0.0,
        maximum=1.0,
        unit="fraction",
    )
    """Roughness as users set it, not its square."""
    direct_light: DirectLight = setting(
        DirectLight.RAYS,
        "Direct Light",
        "How light that comes straight from a source is estimated",
        choices={
            DirectLight.RAYS: ("Rays", "Follow a ray to a light from each point: less noise"),
            DirectLight.PHOTONS: (
                "Photons",
                "Use the photons that come straight from the lights, as the paper does",
            ),
        },
    )
    use_final_gather: bool = setting(
        True,
        "Final Gather",
        "Look for light from other surfaces along one ray from each point, and take only direct light and caustics "
        "from the photons there: fine noise in place of blotches, slower samples",
    )

    @property
    def bounce_limits(self) -> tuple[int, int, int, int]:
        """Most bounces by type, in the order of Scatter; NO_BOUNCE_LIMIT where the limit of all is as strict or counts
        do not reach it."""
        limits = (self.diffuse_bounces, self.glossy_bounces, self.transmission_bounces)
        first, second, third = (
            limit if limit < min(self.max_bounces, MOST_COUNTED_BOUNCES) else NO_BOUNCE_LIMIT for limit in limits
        )
        return first, second, third, NO_BOUNCE_LIMIT

    @property
    def limits_bounces_by_type(self) -> bool:
        """Whether a limit by type ends paths that the limit of all bounces does not."""
        return any(limit != NO_BOUNCE_LIMIT for limit in self.bounce_limits)

    @property
    def camera_bounces(self) -> int:
        """Bounces of a camera path to the last vertex at which light is estimated."""
        return min(self.max_bounces, self.camera_path_length - 1)

    @property
    def photon_bounces(self) -> int:
        """Bounces of a photon to the last surface that stores it."""
        return min(self.max_bounces, self.photon_path_length - 1)

    @property
    def camera_segments(self) -> int:
        """Most rays of a camera path; the one behind the last bounce sees only emission."""
        return min(self.camera_bounces + 2 + self.transparent_max_bounces + _MOST_PASSED, MOST_SEGMENTS)

    @property
    def photon_segments(self) -> int:
        """Most rays of a photon path."""
        return min(self.photon_bounces + 1 + self.transparent_max_bounces + _MOST_PASSED, MOST_SEGMENTS)
