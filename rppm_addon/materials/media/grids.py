# SPDX-License-Identifier: GPL-3.0-or-later
"""Grids of the media whose coefficients vary from place to place, baked on the device."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from ...gl.buffer_sets import BufferSet, Part, StorageBuffer
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ...scene.node_graphs import NodeGraph
from ...scene.scene import Scene
from ...scene.volumes import Volume
from ..records import MEDIUM, PHASE_FUNCTION
from ..traits.interiors import Evaluate, Interior, Variation
from .advection import MovingGrid, VoxelAdvection, reached_bricks
from .bricks import BrickGrid, Lattice, brick_grid, usable
from .emission_cells import EmissionCells

VOXELS_ALONG = 128
"""Voxels along the longest side of a grid whose object says nothing of its own."""
MAX_VOXELS = 1 << 24
"""Voxels of all grids that differ, with those of empty bricks."""
MAX_GRID_BYTES = 1 << 30
"""Bytes of all grids on the device, at most."""
_FEWEST_VOXELS = 8
"""Voxels of a grid, at least."""


@dataclass(frozen=True)
class PlacedMedium:
    """A medium that varies, within an instance or the scene."""

    interior: Interior
    box: tuple[np.ndarray, np.ndarray] | None
    """Lowest and highest coordinates of its grid, each (3,), in the space of the object; None without any."""
    matrix: np.ndarray
    """(4, 4) from that space to the world."""
    instance: int
    """Number of the instance among those with triangles, or WORLD."""
    spacing: np.ndarray | None
    """(3,) distances between voxels that its volume has, meters in the space of the object; None without one."""
    factor: float
    """Factor of the coefficients, which may be by length in the space of the object."""
    volume: Volume | None
    attributes: Mapping[str, tuple[float, ...]]
    """Values of attributes that the object has as a whole."""
    source: tuple[object, ...]
    """Objects that the coefficients follow from. Media with the very same have the same grid."""

    @property
    def key(self) -> tuple[int, ...]:
        """The identities of its sources."""
        return tuple(map(id, self.source))

    @property
    def to_object(self) -> np.ndarray | None:
        """(4, 4) matrix from the world; None where there is none."""
        if not np.isfinite(self.matrix).all() or abs(np.linalg.det(self.matrix[:3, :3])) < 1e-30:
            return None
        return np.linalg.inv(np.asarray(self.matrix, np.float64))

    def lattice(self, most: int) -> Lattice | None:
        """The lattice of at most so many voxels; None for a medium without a place."""
        if self.box is None or self.to_object is None:
            return None
        low, high = self.box
        along = VOXELS_ALONG if self.interior.variation > Variation.OBJECT else 2
        spacing: float | np.ndarray = float(np.max(high - low)) / (along - 1)
        if self.spacing is not None:  # whose voxels stay where they are, and may be divided
            spacing = self.spacing / max(1.0, np.floor(np.min(self.spacing / spacing)))
        return Lattice.of(low, high, spacing, most)


EvaluateVoxels = Callable[[NodeGraph, Lattice, PlacedMedium], np.ndarray]
"""Gives the (bricks, BRICK_VOXELS, 3) float32 coefficient of a graph at a lattice."""


@dataclass(frozen=True)
class BakedMedium:
    """The coefficients of a medium on a lattice."""

    source: tuple[object, ...]
    """PlacedMedium.source, whose identities stay theirs while the bake is kept."""
    lattice: Lattice
    grid: BrickGrid
    functions: np.ndarray
    """(n,) PHASE_FUNCTION, with the means of the scattering coefficients."""
    emission_cells: EmissionCells | None
    """Voxels that shine."""
    moving: MovingGrid | None = None
    """The grid where velocities move its values."""

    @property
    def word_count(self) -> int:
        """Words on the device."""
        return len(self.grid.words) * (1 if self.moving is None else 2)

    def record(self, placed: PlacedMedium, first_word: int) -> np.void:
        """The MEDIUM record of a medium with these coefficients, whose words begin at ``first_word``."""
        record = MEDIUM.zeros(1)[0]
        to_object = placed.to_object
        if to_object is None:
            return record
        record["absorption"], record["scattering"], record["emission"] = placed.factor * self.grid.scales
        record["channels"], record["voxels"], record["first_word"] = self.grid.channels, self.lattice.voxels, first_word
        for row, values in enumerate((self.lattice.to_grid @ to_object)[:3]):
            record[f"to_grid{row}"] = values
        record["function_count"] = len(self.functions)
        return record


class MediumGrids(BufferSet):
    """The buffer MediumVoxels (shaders/media/grid.glsl). What was baked stays while its sources do."""

    remedy = "use smaller or fewer volumes that vary"
    _voxels = StorageBuffer("voxels of media", "uint", texel_bytes=4, block="MediumVoxels")
    _advection = Part(VoxelAdvection)

    def __init__(self, context: Context, library: ProgramLibrary, sizes: object = None) -> None:
        super().__init__(context, library, sizes)
        self._baked: dict[tuple[int, ...], BakedMedium] = {}
        self._most = 0
        """Voxels of a grid, at most, in the last bake."""
        self._first_moved: list[int] = []
        """Where the words of each grid that moves begin."""

    def bake(
        self, scene: Scene, media: list[PlacedMedium], evaluate: EvaluateVoxels, evaluate_once: Evaluate
    ) -> list[tuple[np.void, np.ndarray]]:
        """The MEDIUM record of each medium and its (n,) PHASE_FUNCTION records; their voxels are on the device then.

        evaluate_once: gives the inputs of phase functions, which are the same everywhere in a medium. Where the voxels
        of all grids would not fit, they are larger, with a warning in scene.warnings.
        """
        most = MAX_VOXELS // max(len({medium.key for medium in media}), 1)
        limit = min(self._voxels.limit, MAX_GRID_BYTES) // 4
        self._bake_all(media, most, evaluate, evaluate_once)
        if self._word_count > limit:
            scene.warn(
                f"The grids of volumes need {self._word_count / 2**18:.1f} MiB, but {limit / 2**18:.1f} MiB fit; their "
                f"voxels are made larger: {self.remedy} for finer ones"
            )
        while self._word_count > limit and most > _FEWEST_VOXELS:
            most = min(most, max(int(np.prod(baked.lattice.voxels)) for baked in self._baked.values()))
            most = int(most * min(0.7, 0.9 * limit / self._word_count))
            self._bake_all(media, most, evaluate, evaluate_once)
        return self._upload(media)

    def advect(self, time: float) -> None:
        """Move the values of grids to where their velocities bring them by a time of the shutter, 0 to 1."""
        self._advection.run(time, self._first_moved, self._voxels.buffer)

    def baked(self, placed: PlacedMedium) -> BakedMedium | None:
        """Return a medium of the last bake; None for one without a place."""
        return self._baked.get(placed.key)

    @property
    def _word_count(self) -> int:
        return sum(baked.word_count for baked in self._baked.values())

    def _bake_all(
        self, media: list[PlacedMedium], most: int, evaluate: EvaluateVoxels, evaluate_once: Evaluate
    ) -> None:
        before, self._baked = self._baked if most == self._most else {}, {}
        self._most = most
        for placed in media:
            lattice = placed.lattice(most)
            if placed.key not in self._baked and lattice is not None:
                known = before.get(placed.key)
                self._baked[placed.key] = known or _baked(placed, lattice, evaluate, evaluate_once)

    def _upload(self, media: list[PlacedMedium]) -> list[tuple[np.void, np.ndarray]]:
        firsts, parts, end = {}, [np.zeros(1, np.uint32)], 1
        for key, baked in self._baked.items():
            firsts[key] = end
            parts.append(baked.grid.words_at(end))
            end += len(parts[-1])
        self._voxels.upload(np.concatenate(parts))
        moving = {key: baked.moving for key, baked in self._baked.items() if baked.moving is not None}
        self._first_moved = [firsts[key] for key in moving]
        self._advection.upload(list(moving.values()))
        found = []
        for placed in media:
            baked_medium = self._baked.get(placed.key)
            if baked_medium is None:
                found.append((MEDIUM.zeros(1)[0], PHASE_FUNCTION.zeros(0)))
            else:
                found.append((baked_medium.record(placed, firsts[placed.key]), baked_medium.functions.copy()))
        return found


def _baked(placed: PlacedMedium, lattice: Lattice, evaluate: EvaluateVoxels, evaluate_once: Evaluate) -> BakedMedium:
    def coefficient(graph: NodeGraph | None) -> np.ndarray | None:
        return None if graph is None else usable(evaluate(graph, lattice, placed))

    interior = placed.interior
    functions = PHASE_FUNCTION.zeros(len(interior.scattering))
    scattering: np.ndarray | None = None
    for function, part in zip(functions, interior.scattering, strict=True):
        values = coefficient(part.coefficient)
        assert values is not None
        function["scattering"] = values.mean(axis=(0, 1), dtype=np.float64)
        function["kind"], function["parameters"] = part.kind, part.parameters(evaluate_once)
        scattering = values if scattering is None else scattering + values
    emission = coefficient(interior.emission)
    coefficients = coefficient(interior.absorption), scattering, emission
    motion = None if placed.volume is None else placed.volume.motion
    if motion is None:
        cells = None if emission is None else EmissionCells.of(emission, lattice)
        return BakedMedium(placed.source, lattice, brick_grid(coefficients), functions, cells)
    filled = np.any([values.any(axis=(1, 2)) for values in coefficients if values is not None], axis=0)
    reached = reached_bricks(filled, lattice, motion)
    cells = None if emission is None else EmissionCells.swept(emission, lattice, motion, reached)
    moving = MovingGrid(brick_grid(coefficients, reached), lattice, motion)
    return BakedMedium(placed.source, lattice, moving.grid, functions, cells, moving)
