# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of the structures and routes by which hits and photons are found: the same light, at different speed."""

import enum
from dataclasses import dataclass

from ..errors import SettingsError
from .group import SettingGroup
from .setting_info import setting

CUBEMAP_COSTS = ("steps", "tests", "list", "entries")
"""Costs of a ray in the deep cubemap: cells visited; triangles tested; entries in the cell of the hit, 0 where nothing
is hit; entries read."""


class DensityEstimation(enum.Enum):
    """Route by which photons and importons meet: the same picture, at different speed."""

    AUTOMATIC = "AUTOMATIC"
    """Whichever is faster, found by trying both."""
    RASTERIZED = "RASTERIZED"
    """Photons are splatted by rasterization, as in the paper."""
    GRID = "GRID"
    """Photons are gathered from hashed grids."""


class FirstCameraHits(enum.Enum):
    """Route to the first hits of cameras without depth of field: nearly the same hits, at different speed."""

    AUTOMATIC = "AUTOMATIC"
    """Traced where the processor stands in for a GPU, otherwise rasterized."""
    RASTERIZED = "RASTERIZED"
    """The camera rasterizes what it sees, as in the paper."""
    TRACED = "TRACED"
    """Through the acceleration structure, like all later segments."""


class FirstPhotonHits(enum.Enum):
    """Route to the first hits of photons: the same hits, at different speed."""

    AUTOMATIC = "AUTOMATIC"
    """Traced at first, then whichever is faster, found by trying both."""
    RASTERIZED = "RASTERIZED"
    """Point lights, spots and suns rasterize what they see, as in the paper."""
    TRACED = "TRACED"
    """Through the acceleration structure, like all later segments."""


class AccelerationStructure(enum.Enum):
    """Structure that rays are traced through: the same hits, at different speed."""

    AUTOMATIC = "AUTOMATIC"
    """The BVH where the processor stands in for a GPU, otherwise the deep cubemap."""
    DEEP_CUBEMAP = "DEEP_CUBEMAP"
    """Built by rasterization, as in the paper."""
    BVH = "BVH"
    """A bounding volume hierarchy."""


class Instancing(enum.Enum):
    """Place of the triangles of instances: the same picture, with another need of memory."""

    AUTOMATIC = "AUTOMATIC"
    """Two levels for millions of triangles of few meshes, otherwise expanded."""
    EXPANDED = "EXPANDED"
    """Each instance has triangles of its own in the world."""
    TWO_LEVELS = "TWO_LEVELS"
    """Rays that meet an instance go on in its mesh, which all its instances share."""


@dataclass
class AccelerationSettings(SettingGroup):
    """Choices between rasterization, rays and grids."""

    density_estimation: DensityEstimation = setting(
        DensityEstimation.AUTOMATIC,
        "Density Estimation",
        "How photons and the points that take them find each other: any way gives the same picture",
        choices={
            DensityEstimation.AUTOMATIC: ("Automatic", "Try both with the first photons and take the faster one"),
            DensityEstimation.RASTERIZED: (
                "Rasterized",
                "Splat photons onto pixels by rasterization, as the paper does",
            ),
            DensityEstimation.GRID: (
                "Photon Grid",
                "Sort photons into grids of cells, and look for them in the cells around",
            ),
        },
    )
    use_splat_roulette: bool = setting(
        False,
        "Splat Roulette",
        "Leave out half of the splats at random and count the others twice: faster samples, more noise",
        where="nowhere",
    )
    """Paper section 4.2, Fig. 5, which `make bench` measures. At equal time, the variance is three times that without
    it on two of three scenes."""
    first_camera_hits: FirstCameraHits = setting(
        FirstCameraHits.AUTOMATIC,
        "First Camera Hits",
        "How it is found what cameras without depth of field see: pictures differ by rounding at edges only",
        choices={
            FirstCameraHits.AUTOMATIC: (
                "Automatic",
                "Trace where the processor stands in for a GPU, otherwise rasterize",
            ),
            FirstCameraHits.RASTERIZED: ("Rasterized", "Rasterize what the camera sees, as the paper does"),
            FirstCameraHits.TRACED: ("Traced", "Trace rays, as for all later hits"),
        },
    )
    first_photon_hits: FirstPhotonHits = setting(
        FirstPhotonHits.AUTOMATIC,
        "First Photon Hits",
        "How it is found where photons from point lights, spots and suns hit first: any way gives the same picture",
        choices={
            FirstPhotonHits.AUTOMATIC: (
                "Automatic",
                "Trace the first samples, then try both and take the faster one",
            ),
            FirstPhotonHits.RASTERIZED: (
                "Rasterized",
                "Rasterize what point lights, spots and suns see, as the paper does",
            ),
            FirstPhotonHits.TRACED: ("Traced", "Trace rays, as for all later hits"),
        },
    )
    acceleration_structure: AccelerationStructure = setting(
        AccelerationStructure.AUTOMATIC,
        "Acceleration Structure",
        "What rays are traced through: any structure gives the same picture",
        choices={
            AccelerationStructure.AUTOMATIC: (
                "Automatic",
                "The BVH where the processor stands in for a GPU, otherwise the deep cubemap",
            ),
            AccelerationStructure.DEEP_CUBEMAP: (
                "Deep Cubemap",
                "A cubemap of lists of triangles, which is built by rasterization, as in the paper",
            ),
            AccelerationStructure.BVH: (
                "BVH",
                "A bounding volume hierarchy, which the processor builds; it takes less memory",
            ),
        },
    )
    instancing: Instancing = setting(
        Instancing.AUTOMATIC,
        "Instances",
        "Where the triangles of instances are: any way gives the same picture",
        choices={
            Instancing.AUTOMATIC: (
                "Automatic",
                "Two levels where the instances of a few meshes have millions of triangles, or more than the device "
                "holds, otherwise expanded",
            ),
            Instancing.EXPANDED: ("Expanded", "Each instance has triangles of its own: rays are faster"),
            Instancing.TWO_LEVELS: (
                "Two Levels",
                "Instances share the triangles of their mesh: memory does not grow with their number, and moving them "
                "rebuilds little. Boxes of Volume objects, and what glows and bends under motion blur, are expanded "
                "all the same. The camera traces its first hits",
            ),
        },
    )
    cubemap_resolution: int = setting(
        0,
        "Cubemap Resolution",
        "The most cells along a side of the deep cubemap's faces, a power of two from 16 to 16384. They are that fine "
        "only where many triangles crowd; fewer take less memory, and rays take longer; 0 is automatic",
        minimum=0,
        maximum=16384,
        zero="automatic",
    )

    def validate(self) -> None:
        """Raise SettingsError for a value out of its range, or a cubemap resolution that is no power of two."""
        super().validate()
        resolution = self.cubemap_resolution
        if resolution and (resolution < 16 or resolution & (resolution - 1)):
            raise SettingsError(
                f"cubemap_resolution is {resolution}; set it to 0 (automatic) or a power of two from 16 to 16384"
            )
