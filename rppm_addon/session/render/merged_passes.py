# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes of a picture whose iterations were rendered in parts."""

from collections.abc import Mapping, Sequence

import numpy as np

from ...scene.cryptomatte import MergedCoverage, joined, layers_of, split
from ...scene.passes import Accumulation, RenderPass


class MergedPasses:
    """Passes that a film would hold if it had seen the iterations of all parts. Parts are added in their order."""

    def __init__(self, entries: Sequence[RenderPass]) -> None:
        """entries: the passes that the film finds."""
        self._entries = [entry for entry in entries if entry.is_accumulated]
        self._sums: dict[str, np.ndarray] = {}
        self._coverage: dict[str, MergedCoverage] = {}
        self._counts = np.zeros((0, 0, 2), np.int64)
        self._iterations = 0

    def add(self, passes: Mapping[str, np.ndarray], counts: np.ndarray, iterations: int) -> None:
        """Add a part of so many iterations: RenderState.passes and RenderState.pass_counts."""
        if not self._counts.size:
            self._counts = np.zeros(counts.shape, np.int64)
        for layer, parts in layers_of(self._entries).items():
            self._coverage.setdefault(layer, MergedCoverage(parts)).add(joined(parts, passes), iterations)
        for entry in self._entries:
            if entry.accumulation is Accumulation.COVERAGE:
                continue
            values = passes[entry.name]
            depth = values.ndim - 2
            found_before, found_here = (
                found.reshape(*found.shape, *[1] * depth) for found in (self._counts[..., 1] > 0, counts[..., 0])
            )
            if entry.accumulation is Accumulation.MEAN:
                self._sums[entry.name] = self._sums.get(entry.name, 0.0) + values.astype(np.float64) * found_here
            elif entry.accumulation is Accumulation.SURFACE_MEAN:
                weight = counts[..., 1].reshape(found_here.shape)
                self._sums[entry.name] = self._sums.get(entry.name, 0.0) + values.astype(np.float64) * weight
            elif entry.accumulation is Accumulation.SUM:
                self._sums[entry.name] = self._sums.get(entry.name, 0.0) + values.astype(np.float64) * iterations
            else:
                before = self._sums.get(entry.name, values)
                self._sums[entry.name] = np.where(found_before, before, values)
        self._counts = self._counts + counts
        self._iterations += iterations

    def result(self) -> dict[str, np.ndarray]:
        """The passes, float32, as Frame.passes has them."""
        found = {}
        for entry in self._entries:
            if entry.name not in self._sums:
                continue
            values = self._sums[entry.name]
            if entry.accumulation in {Accumulation.MEAN, Accumulation.SURFACE_MEAN}:
                counts = np.maximum(self._counts[..., int(entry.accumulation is Accumulation.SURFACE_MEAN)], 1)
                values = values / counts.reshape(*counts.shape, *[1] * (values.ndim - 2))
            elif entry.accumulation is Accumulation.SUM:
                values = values / max(self._iterations, 1)
            found[entry.name] = values.astype(np.float32)
        for coverage in self._coverage.values():
            found |= split(coverage.entries, coverage.pairs(max(self._iterations, 1)))
        return found
