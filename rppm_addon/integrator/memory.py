# SPDX-License-Identifier: GPL-3.0-or-later
"""Bytes on the device by group of buffers, and the PPM buffers against the paper's 32 R + 64 M L (section 5.1)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from ..scene.passes import RenderPass, passes_named
from ..scene.settings import DensityEstimation, RenderSettings
from .common.stage_sizes import StageSizes, film_pixels
from .common.viewport_demands import with_filtered
from .density_estimation.density_estimator import ROUTES
from .stage_set import expected_groups
from .surfaces.hit_triangles import expected_hit_bytes
from .viewport.pictures import expected_bytes

PPM_BUFFERS = ("film", "gathered radiance", "photons")
"""Running mean of radiance (16 R), sums of splats (48 bytes a pixel of one band of rows), photons (64 M L)."""


@dataclass(frozen=True)
class Memory:
    """Bytes on the device of one scene."""

    pixels: int
    """R: pixels of the region that is rendered."""
    photons: int
    """M: photons of an iteration."""
    segments: int
    """L: segments of a photon path, the first leaving the light."""
    ppm: dict[str, int]
    """Bytes by buffer of what the paper counts."""
    working: dict[str, dict[str, int]]
    """Bytes by group and buffer of everything else."""

    @property
    def ppm_bytes(self) -> int:
        """Bytes of all buffers that the paper counts."""
        return sum(self.ppm.values())

    @property
    def paper_bytes(self) -> int:
        """Bytes that the paper's PPM buffers would take: 32 R + 64 M L."""
        return 32 * self.pixels + 64 * self.photons * self.segments

    @property
    def working_bytes(self) -> dict[str, int]:
        """Sums by group."""
        return {name: sum(sizes.values()) for name, sizes in self.working.items()}

    @property
    def total_bytes(self) -> int:
        """Bytes of everything on the device."""
        return self.ppm_bytes + sum(self.working_bytes.values())

    def as_dict(self) -> dict[str, object]:
        """Plain values for JSON."""
        return {
            "pixels": self.pixels,
            "photons": self.photons,
            "segments": self.segments,
            "ppm": self.ppm,
            "ppm_bytes": self.ppm_bytes,
            "paper_bytes": self.paper_bytes,
            "working": self.working,
            "working_bytes": self.working_bytes,
            "total_bytes": self.total_bytes,
        }


def compute_memory(groups: Mapping[str, Mapping[str, int]], pixels: int, photons: int, segments: int) -> Memory:
    """Take the PPM buffers out of ``groups``, bytes by group and buffer; what remains is working memory."""
    everything = {name: size for sizes in groups.values() for name, size in sizes.items()}
    ppm = {name: everything[name] for name in PPM_BUFFERS if name in everything}
    working = {
        group: {name: size for name, size in sizes.items() if name not in ppm} for group, sizes in groups.items()
    }
    return Memory(pixels, photons, segments, ppm, {group: sizes for group, sizes in working.items() if sizes})


def expected_memory(
    width: int,
    height: int,
    photons: int,
    segments: int,
    rasterized: bool = False,
    passes: Sequence[RenderPass] = passes_named(RenderSettings.passes),
    measures_noise: bool = False,
    in_viewport: bool = False,
    in_two_levels: bool = False,
) -> Memory:
    """The buffers whose size follows from the settings, known before anything is rendered.

    rasterized: whether photons are splatted by rasterization, not gathered from a grid.
    passes: those that are rendered.
    measures_noise: whether there is a noise threshold.
    in_viewport: whether a viewport shows the pictures, which it filters and moves.
    in_two_levels: whether rays place instances in the world, and paths have places for what they hit.
    What the scene takes is missing: geometry, textures, lights, deep cubemap, and lists as long as photons are stored.
    """
    kept = with_filtered(tuple(passes)) if in_viewport else tuple(passes)
    sizes = StageSizes(width, height, photons, segments, kept, measures_noise=measures_noise, is_filtered=in_viewport)
    groups = expected_groups(sizes)
    if in_viewport:
        groups["viewport"] = expected_bytes(sizes)
    if in_two_levels:
        groups["scene"] = groups.get("scene", {}) | expected_hit_bytes(sizes)
    route = DensityEstimation.RASTERIZED if rasterized else DensityEstimation.GRID
    groups["density estimation"] |= ROUTES[route].expected_bytes(sizes)
    return compute_memory(groups, film_pixels(sizes), photons, segments)
