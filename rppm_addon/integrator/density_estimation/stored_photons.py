# SPDX-License-Identifier: GPL-3.0-or-later
"""Input of density estimation: the stored photons of an iteration, and the importons that take of them."""

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass

import moderngl
import numpy as np

from ...gl.buffer_sets import BufferSet, StorageBuffer
from ...gl.buffers.records import Record
from ...gl.context.context import Context
from ...gl.programs.bindings import ITERATION
from ...gl.programs.program import Bindable
from ...gl.programs.programs import ProgramLibrary
from ..common.active_paths import ActivePaths
from ..common.stage_sizes import StageSizes, photon_slots
from .radii import SplatRadii

Record("StoredParameters", count="uint", takes_direct="uint")


class PhotonList(BufferSet):
    """The numbers of the photons that importons may take.

    ``count`` is how many there are. ``global_photon_count`` of them are global photons, which a diffuse surface has
    scattered (Jensen 2001), and ``indirect_count`` were scattered last by a surface that stores photons.
    """

    remedy = "lower the photons per iteration or the photon path length"
    _numbers = StorageBuffer("stored photons", "uint", photon_slots, header="uvec3", block="StoredPhotons")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        self._program = library.compute("density_estimation/stored_photons/list.comp")
        self.count = self.global_photon_count = self.indirect_count = 0

    @property
    def buffer(self) -> moderngl.Buffer:
        """Three uint32, ``count``, ``global_photon_count`` and ``indirect_count``, and the numbers."""
        return self._numbers.buffer

    def collect(
        self,
        blocks: Mapping[str, Bindable],
        slots: int,
        takes_direct: bool,
    ) -> None:
        """List the photons that are stored, with those straight from lights where ``takes_direct``.

        blocks: Photons and PhotonRange, of no more than so many slots.
        """
        self._numbers.require_items(slots)
        self._numbers.write(np.zeros(3, np.uint32))
        self._program.run(
            slots,
            {**blocks, **self.blocks},
            {"count": slots, "takes_direct": takes_direct},
        )
        self.count, self.global_photon_count, self.indirect_count = map(int, self._numbers.read(np.uint32, 3))


@dataclass(frozen=True)
class StoredPhotons:
    """The photons of an iteration that importons may take, and what else their estimate depends on."""

    photons: moderngl.Buffer
    numbers: moderngl.Buffer
    """PhotonList's."""
    count: int
    caustic_count: int
    """No more than so many of them have come by specular surfaces or from a light only."""
    global_photon_count: int
    """No more than so many of them has a diffuse surface scattered."""
    indirect_count: int
    """So many of all of them importons leave to gathering rays."""
    photon_origins: moderngl.Buffer
    photon_flux: float
    """Mean flux of all lights' photons as they leave, W, which are allocated by power."""
    radii: SplatRadii
    largest_coordinate: float
    """Largest coordinate of any position, by its absolute value, meters."""
    iteration_block: moderngl.Buffer
    """The uniform block Iteration."""

    def first(self, count: int) -> "StoredPhotons":
        """No more than so many of them."""
        return dataclasses.replace(
            self,
            count=min(count, self.count),
            caustic_count=min(count, self.caustic_count),
            global_photon_count=min(count, self.global_photon_count),
        )

    @property
    def blocks(self) -> dict[str, Bindable]:
        """Storage blocks of programs that go through the list, or estimate densities."""
        return {
            "Photons": self.photons,
            "StoredPhotons": self.numbers,
            "PhotonOrigins": self.photon_origins,
            ITERATION: self.iteration_block,
        }


@dataclass(frozen=True)
class CameraRaster:
    """The band of pixels on which the camera's first hits were rasterized."""

    camera: moderngl.Buffer
    width: int
    rows: int


@dataclass(frozen=True)
class SplatTargets:
    """The importons of a segment of a band's camera paths, one a pixel."""

    importons: moderngl.Buffer
    paths: moderngl.Buffer
    """CAMERA_PATH of each importon."""
    active: ActivePaths
    """The paths that came to this segment: what others have left in ``importons`` is of segments before."""
    gathers: bool
    """Whether the paths go on from there to gather: then the importons take no indirect photons."""
    final_gather: bool
    """Whether gathering rays may have led there, which widens the narrow radius."""
    raster: CameraRaster | None
    """Place of first hits on the camera's raster."""
    center: np.ndarray
    """Center of the splat cubemap, which serves importons without a raster, (3,) meters; it changes no sum."""

    @property
    def blocks(self) -> dict[str, Bindable]:
        """Storage blocks of programs that estimate densities."""
        return {"Importons": self.importons, "CameraPaths": self.paths}

    def narrow_radius(self, photons: StoredPhotons) -> float:
        """Return the upper limit of the narrow radii of these importons, meters."""
        return photons.radii.final_gather if self.final_gather else photons.radii.caustic

    def minimum_radius(self, photons: StoredPhotons) -> float:
        """Return the upper limit of the minimum radii of these importons, meters."""
        return photons.radii.final_gather if self.final_gather else photons.radii.narrow
