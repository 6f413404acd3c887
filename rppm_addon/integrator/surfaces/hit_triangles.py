# SPDX-License-Identifier: GPL-3.0-or-later
"""World-space triangles of what rays hit on instances that are not expanded."""

from collections.abc import Mapping
from collections.abc import Set as AbstractSet

import moderngl
import numpy as np

from ...gl.buffer_sets import BufferSet, StorageBuffer
from ...gl.buffers.buffers import GrowingBuffer, next_range
from ...gl.buffers.records import Record
from ...gl.context.context import Context
from ...gl.programs.program import Bindable
from ...gl.programs.programs import ProgramLibrary
from ..acceleration.instances import HitNumbers, HitPaths
from ..common.active_paths import ActivePaths
from ..common.records.triangles import TRIANGLE_ATTRIBUTES, TRIANGLE_VERTICES
from ..common.stage_sizes import StageSizes, band_pixels, photon_paths, subsurface_walks

Record("GatherHitsParameters", fallback_point="vec3", first_hit="uint", hit_count="uint")
_PATHS = {
    HitPaths.CAMERA: band_pixels,
    HitPaths.PHOTON: photon_paths,
    HitPaths.SHADOW: band_pixels,
    HitPaths.SUBSURFACE: subsurface_walks,
    HitPaths.LIGHT: band_pixels,
}
"""Number of paths of each list, by the sizes of a scene."""


def traced_lists(sizes: StageSizes, passes_surfaces: bool, has_emitters: bool = False) -> set[HitPaths]:
    """Lists of paths whose hits are read in scenes of these sizes. passes_surfaces: whether shadow rays pass surfaces;
    has_emitters: whether instances that are not expanded emit light."""
    lists = {HitPaths.CAMERA, HitPaths.PHOTON}
    also = {
        HitPaths.SHADOW: passes_surfaces,
        HitPaths.SUBSURFACE: sizes.has_subsurface,
        HitPaths.LIGHT: has_emitters,
    }
    return lists | {paths for paths, is_traced in also.items() if is_traced}


def _counts(sizes: StageSizes, lists: AbstractSet[HitPaths]) -> dict[HitPaths, int]:
    """Number of places for each list of paths, of which only some are traced in scenes of these sizes."""
    return {
        paths: next_range((1 if paths is HitPaths.LIGHT else 2) * size(sizes)) if paths in lists else 0
        for paths, size in _PATHS.items()
    }


def expected_hit_bytes(sizes: StageSizes) -> dict[str, int]:
    """Bytes by buffer that the hits of a scene of these sizes take on instances that are not expanded, where none of
    these emits light, and none lets shadow rays pass."""
    count = sum(_counts(sizes, traced_lists(sizes, passes_surfaces=False)).values())
    of_each = {
        "hit origins": 8,
        "world triangles": TRIANGLE_VERTICES.size,
        "triangle attributes": TRIANGLE_ATTRIBUTES.size,
    }
    return {name: count * size for name, size in of_each.items()}


class HitTriangles(BufferSet):
    """Places in the blocks Triangles and Attributes for the triangles that paths hit, two for each path, and one for
    each emissive triangle that a shadow ray goes to.

    Stages read a hit triangle as they read any other: ``gather`` fills it in once rays have been traced.
    """

    remedy = "lower the resolution or the photons per iteration"
    origins = StorageBuffer("hit origins", "uvec2", block="HitOrigins")

    def __init__(self, context: Context, library: ProgramLibrary) -> None:
        super().__init__(context, library)
        self._library = library
        self._gather_listed = library.compute("surfaces/geometry/gather_listed.comp")
        self.first = self.count = 0
        """First hit triangle, and their number."""
        self.first_hits: dict[HitPaths, int] = {}
        """The first hit triangle of each list of paths, counted from ``first``."""
        self._counts: dict[HitPaths, int] = {}

    def place(self, first: int, sizes: StageSizes | None, lists: AbstractSet[HitPaths]) -> None:
        """Have places for the paths of a scene of these sizes from a triangle on; for none without sizes.
        lists: those that are traced."""
        self.first, self.count, self.first_hits = first, 0, {}
        self._counts = {} if sizes is None else _counts(sizes, lists)
        if sizes is None:
            return
        for paths, count in self._counts.items():
            self.first_hits[paths] = self.count
            self.count += count
        self.origins.require_items(self.count)

    def has_room(self, sizes: StageSizes, lists: AbstractSet[HitPaths]) -> bool:
        """Return True where there are places for the paths of a scene of these sizes. lists: as place takes them."""
        return all(self._counts[paths] >= count for paths, count in _counts(sizes, lists).items())

    @property
    def listed_count(self) -> int:
        """Number of triangles that gather_listed takes at a time."""
        return self._counts[HitPaths.PHOTON]

    def gather_listed(
        self,
        placements: np.ndarray,
        triangles: np.ndarray,
        blocks: Mapping[str, Bindable],
        outputs: tuple[GrowingBuffer, GrowingBuffer],
        fallback_point: np.ndarray,
    ) -> np.ndarray:
        """Write triangles (n,) of the meshes of placements (n,) while no paths are traced; returns their numbers, (n,).

        ``blocks``, ``outputs``, ``fallback_point``: as of gather.
        """
        place, count = self.first_hits[HitPaths.PHOTON], len(triangles)
        origins = np.stack([placements, triangles], axis=1).astype(np.uint32)
        self.origins.write(origins, self.origins.item_size * place)
        ((written,), (attributes,)) = (buffer.ranges(count, self.first + place) for buffer in outputs)
        self._gather_listed.run(
            count,
            {**blocks, **self.blocks, "Triangles": written, "Attributes": attributes},
            {"fallback_point": fallback_point, "first_hit": place, "hit_count": count},
        )
        return self.first + place + np.arange(count)

    def gather(
        self,
        numbers: moderngl.Buffer,
        kind: HitNumbers,
        active: ActivePaths,
        paths: HitPaths,
        blocks: Mapping[str, Bindable],
        outputs: tuple[GrowingBuffer, GrowingBuffer],
        fallback_point: np.ndarray,
    ) -> None:
        """Write the triangles that a buffer, of some kind, names for the active paths of a list.

        ``blocks``: the inputs of gathering, and those of the acceleration structure; ``outputs``: world triangles and
        their attributes; ``fallback_point``: of triangles that are not finite, (3,) meters.
        """
        first, count = self.first_hits[paths], self._counts[paths]
        ((triangles,), (attributes,)) = (buffer.ranges(count, self.first + first) for buffer in outputs)
        buffers = {**blocks, **self.blocks, kind.block: numbers, "Triangles": triangles, "Attributes": attributes}
        defines: dict[str, object] = {"HIT_NUMBERS": kind.shader} if kind is not HitNumbers.HITS else {}
        if self._counts[HitPaths.LIGHT]:
            defines["INSTANCED_EMITTERS"] = 1
        program = self._library.compute("surfaces/geometry/gather_hits.comp", defines)
        active.run(program, buffers, {"fallback_point": fallback_point, "first_hit": first, "hit_count": count})
