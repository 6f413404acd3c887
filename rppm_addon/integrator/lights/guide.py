# SPDX-License-Identifier: GPL-3.0-or-later
"""Photons sent where earlier ones came to importons.

After Hachisuka and Jensen, Robust Adaptive Photon Tracing using Photon Path Visibility (2011), with tallies in place
of their Markov chains: the unit cube of the random numbers that place and direct a light's photons is cut into
cells, and a cell is chosen by how often its photons contributed. Every cell keeps a fraction, and the flux is divided
by the density, so energy stays as it is.
"""

from collections.abc import Mapping

import numpy as np

from ...gl.buffer_sets import BufferSet, StorageBuffer
from ...gl.buffers.constants import Constants
from ...gl.buffers.records import Record
from ...gl.buffers.storage_blocks import StorageBlock
from ...gl.context.context import Context
from ...gl.programs.program import Bindable
from ...gl.programs.programs import ProgramLibrary
from .light_records import LightShape

StorageBlock("PhotonCells", "uint photon_cells[];")
Constants("GuideCells", NO_CELL=0xFFFFFFFF, CELL_CONTRIBUTED=1 << 31)
"""The latter marks cells of photons that have been counted."""
Record("LearnParameters", count="uint")

DEFENSIVE_FRACTION = 0.25
"""Fraction of the photons that leave as if there were no guide: none has more than four times its plain flux."""

_PRIOR_PHOTONS = 4.0
"""Photons that a cell needs until it is believed more than the cells around it."""

_DOUBTED_PHOTONS = 32.0
"""Photons of a light after which, if none contributed, it is as likely that none ever will."""

FINEST_CELLS = {
    LightShape.POINT: (1, 1, 128, 128),
    LightShape.SPOT: (1, 1, 128, 128),
    LightShape.SUN: (128, 128, 1, 1),
    LightShape.RECTANGLE: (8, 8, 16, 16),
    LightShape.ELLIPSE: (8, 8, 16, 16),
    LightShape.MESH: (16, 1, 32, 32),
    LightShape.WORLD: (16, 16, 16, 16),
    LightShape.MEDIUM: (16, 1, 32, 32),
}
"""Cells along the place on the light and the direction, by kind; for MESH the first is the triangle, for MEDIUM the
voxel."""


def cells_of(kind: int, photons: int) -> tuple[int, ...]:
    """Cells along each number, powers of two: at most one for each photon."""
    cells = list(FINEST_CELLS[LightShape(kind)])
    while np.prod(cells) > max(photons, 1):
        most = max(cells)
        cells[3 - cells[::-1].index(most)] //= 2
    return tuple(cells)


def contribution_probability(left: np.ndarray, contributed: np.ndarray) -> np.ndarray:
    """Fraction of each cell's photons that contribute, from tallies of any shape of powers of two.

    A cell with few photons is taken for the coarser cell that it lies in, that for the next coarser, and so on. What is
    believed of a light of which none contribute falls with the square of their number, as it may be one that shines
    elsewhere: however powerful, it leaves the photons to lights that are seen.
    """
    if left.size == 1:
        hopes = np.where(contributed > 0, 1.0, _DOUBTED_PHOTONS / (_DOUBTED_PHOTONS + left))
        return (contributed + 0.5 * hopes) / (left + 1.0)
    halves = tuple(n for size in left.shape for n in ((size // 2, 2) if size > 1 else (1, 1)))
    pairs = tuple(range(1, 2 * left.ndim, 2))
    coarse = contribution_probability(left.reshape(halves).sum(pairs), contributed.reshape(halves).sum(pairs))
    for axis, size in enumerate(left.shape):
        if size > 1:
            coarse = np.repeat(coarse, 2, axis)
    return (contributed + _PRIOR_PHOTONS * coarse) / (left + _PRIOR_PHOTONS)


def probabilities(estimate: np.ndarray) -> np.ndarray:
    """Return the probabilities of choosing cells, (n,) summing to 1: the root of the probability to contribute gives
    the sum of photons the least variance, and a fraction is defensive."""
    weight = np.sqrt(estimate)
    return (1.0 - DEFENSIVE_FRACTION) * weight / weight.sum() + DEFENSIVE_FRACTION / weight.size


def starts(probability: np.ndarray) -> np.ndarray:
    """(n,) uint32 where each cell's part of [0, 2^32) begins."""
    cumulated = np.concatenate([[0.0], np.cumsum(probability)[:-1]])
    return np.minimum(np.floor(cumulated * 2.0**32), 2.0**32 - 1).astype(np.uint32)


class Guide(BufferSet):
    """Cells of all lights: what is known of them, and what an iteration adds."""

    _starts = StorageBuffer("emission guide", "uint", block="Guide")
    _tallies = StorageBuffer("emission tallies", "uvec2", block="Tallies")
    _photon_cells = StorageBuffer("photon cells", "uint", remedy="lower the photons per iteration", block="PhotonCells")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: object = None) -> None:
        super().__init__(context, library, sizes)
        self._program = library.compute("lights/learn.comp")
        self._cells: list[tuple[int, ...]] = []
        self._probabilities: list[np.ndarray] = []
        self.learned: np.ndarray | None = None
        """(cells, 2) uint32: the tallies by which cells are chosen; None while they are chosen evenly."""
        self.even_contribution = np.ones(0)
        """(lights,) the fraction that would contribute if they left evenly."""

    @property
    def _cell_count(self) -> int:
        return sum(int(np.prod(cells)) for cells in self._cells)

    def build(self, lights: np.ndarray, photons: int) -> None:
        """Forget all; set ``cells`` and ``first_cell`` of LIGHT records that have their kind and photon count."""
        self._cells = [cells_of(int(light["kind"]), int(light["photon_count"])) for light in lights]
        counts = np.prod(self._cells, axis=1)
        lights["cells"] = self._cells
        lights["first_cell"] = np.concatenate([[0], np.cumsum(counts)[:-1]])
        self._choose_by([np.full(count, 1.0 / count) for count in counts])
        self.learned = None
        self._tallies.upload(np.zeros((counts.sum(), 2), np.uint32))
        self._photon_cells.require_items(photons)

    def tally(self, blocks: Mapping[str, Bindable], slots: int, count: int) -> None:
        """Count an iteration's photons that contributed, once they have been splatted.

        blocks: Photons and PhotonRange, of no more than so many slots. count: photons that left the lights.
        """
        self._program.run(
            max(slots, count),
            {**self.blocks, **blocks},
            {"count": count},
        )

    def _choose_by(self, found: list[np.ndarray]) -> None:
        self._probabilities = found
        self._starts.upload(np.concatenate([starts(probability) for probability in found]))

    def read_tallies(self) -> np.ndarray:
        """(cells, 2) uint32: the photons that left through each cell so far, and those that contributed."""
        return self._tallies.read(np.uint32, 2 * self._cell_count).reshape(-1, 2).copy()

    def learn(self) -> tuple[np.ndarray, np.ndarray]:
        """Choose cells by the tallies from now on.

        Returns each light's mean root of the probability to contribute, (n,), and the fractions of its photons that
        should have contributed before and will from now on, (n, 2).
        """
        before = self._probabilities
        weights, estimates = self._choose_by_tallies(self.read_tallies())
        fractions = [(b @ estimate, now @ estimate) for b, now, estimate in zip(before, self._probabilities, estimates)]
        return weights, np.array(fractions)

    def restore(self, tallies: np.ndarray, learned: np.ndarray | None) -> np.ndarray | None:
        """Know what read_tallies and ``learned`` said; returns what learn said of the lights, or None before it.

        Raises ValueError when these are not the cells that were tallied.
        """
        shape = (self._cell_count, 2)
        if tallies.shape != shape or (learned is not None and learned.shape != shape):
            raise ValueError(f"the lights have {shape[0]} cells, not {len(tallies)}")
        self._tallies.upload(tallies)
        return None if learned is None else self._choose_by_tallies(learned)[0]

    def _choose_by_tallies(self, tallies: np.ndarray) -> tuple[np.ndarray, list[np.ndarray]]:
        """Each light's mean root of the probability to contribute, and the probability to contribute of its cells."""
        self.learned = tallies
        estimates, first = [], 0
        for cells in self._cells:
            count = int(np.prod(cells))
            part = tallies[first : first + count].astype(np.float64).reshape(*cells[::-1], 2)
            estimates.append(contribution_probability(part[..., 0], part[..., 1]).ravel())
            first += count
        self._choose_by([probabilities(estimate) for estimate in estimates])
        self.even_contribution = np.array([estimate.mean() for estimate in estimates])
        return np.array([np.sqrt(estimate).mean() for estimate in estimates]), estimates
