# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangles whose long edges are halved until none is too long.

An edge is halved or not by its own length, which all triangles around it agree on: neighbors of different fineness meet
without cracks, as with DiagSplit (Fisher et al. 2009), which Cycles uses.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

LONGEST = np.sqrt(2.0)
"""Length beyond which edges are halved, in units of the length that is asked for: the diagonal of a square whose sides
are as long as that."""
_ENDS = np.array([1, 2, 0])
_IN_TWO = [0, 3, 2], [3, 1, 2]
_IN_FOUR = [0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]
_IN_THREE_FROM_FIRST = [3, 1, 4], [0, 3, 4], [0, 4, 2]
_IN_THREE_FROM_LAST = [3, 1, 4], [0, 3, 2], [3, 4, 2]
"""Parts of a triangle by its corners, 0 to 2, and the middles of its edges, 3 to 5, of which the first ones count. In
three, the shorter diagonal divides what remains beside the corner between the two edges."""
_CLEAR, _MANY = 2.0, 1 << 14
"""Excess of triangles, and number of triangles that it is expected of, for which there is no need to halve on."""
_Points = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""Function that returns the points (n, 3) of triangles (n,) at barycentrics (n, 3)."""


@dataclass(frozen=True)
class Refinement:
    """Smaller triangles in place of those of a mesh."""

    triangles: np.ndarray
    """(triangles, 3) int64 vertices: first those of the mesh, then the middles of edges."""
    sources: np.ndarray
    """(triangles,) int64, the triangle of the mesh that each is a part of."""
    weights: np.ndarray
    """(triangles, 3, 3) float32, barycentrics of the corners within the triangle of the mesh."""
    added_sources: np.ndarray
    """(added vertices,) int64, a triangle of the mesh with the vertex."""
    added_weights: np.ndarray
    """(added vertices, 3) float32, the barycentrics there."""


class TooManyTriangles(Exception):
    """More triangles than are allowed.

    excess: about how many times as many the end result would have.
    """

    def __init__(self, excess: float) -> None:
        super().__init__(f"{excess:.2f} times as many triangles as are allowed")
        self.excess = excess


class Refiner:
    """Halves edges of triangles round by round."""

    def __init__(
        self,
        triangles: np.ndarray,
        positions: np.ndarray,
        points: _Points,
        see: Callable[[np.ndarray], np.ndarray],
        lengths: Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray],
    ) -> None:
        """triangles: (n, 3) vertices; positions: (vertices, 3). see, lengths: EdgeLengths.seen and between."""
        self._triangles, self._positions = triangles.astype(np.int64), positions
        self._points, self._see, self._lengths = points, see, lengths

    def refine(self, rounds: int, coarser: float, most: int) -> Refinement:
        """Halve edges longer than LONGEST * coarser, at most ``rounds`` times each.

        Raises TooManyTriangles where that makes more than ``most`` triangles out of fewer.
        """
        count = len(self._triangles)
        active = _Part(self._triangles, np.arange(count), np.tile(np.eye(3, dtype=np.float32), (count, 1, 1)))
        seen, vertices = self._see(self._positions), len(self._positions)
        done: list[_Part] = []
        added: list[tuple[np.ndarray, np.ndarray]] = []
        longest, finished = LONGEST * coarser, 0
        for left in range(rounds, 0, -1):
            lengths = self._lengths(seen, active.vertices, active.vertices[:, _ENDS])
            is_long = lengths > longest
            has_long = is_long.any(axis=1)
            done.append(active.rows(~has_long))
            finished += len(done[-1])
            if not has_long.any():
                break
            active, lengths, is_long = active.rows(has_long), lengths[has_long], is_long[has_long]
            expected = (finished + _expected(lengths / longest, left)) / most
            if finished + len(active) + is_long.sum() > most or (expected > _CLEAR and len(active) > _MANY):
                raise TooManyTriangles(expected)
            active, sources, weights = _halved(active, is_long, lengths, vertices)
            added.append((sources, weights))
            vertices += len(sources)
            seen = np.concatenate([seen, self._see(self._points(sources, weights))], axis=2)
        else:
            done.append(active)
        whole = _Part.joined(done)
        sources = np.concatenate([np.zeros(0, np.int64), *(part[0] for part in added)])
        weights = np.concatenate([np.zeros((0, 3), np.float32), *(part[1] for part in added)])
        return Refinement(whole.vertices, whole.sources, whole.weights, sources, weights)


@dataclass(frozen=True)
class _Part:
    """Triangles: vertices (n, 3), sources (n,) and weights (n, 3, 3) as Refinement has them."""

    vertices: np.ndarray
    sources: np.ndarray
    weights: np.ndarray

    def __len__(self) -> int:
        return len(self.sources)

    def rows(self, chosen: np.ndarray) -> "_Part":
        return _Part(self.vertices[chosen], self.sources[chosen], self.weights[chosen])

    @classmethod
    def joined(cls, parts: "list[_Part]") -> "_Part":
        return cls(
            np.concatenate([part.vertices for part in parts]),
            np.concatenate([part.sources for part in parts]),
            np.concatenate([part.weights for part in parts]),
        )

    def turned(self, first: np.ndarray) -> "_Part":
        """The triangles from another corner on, (n,) for each."""
        order = (first[:, None] + np.arange(3)) % 3
        return _Part(
            np.take_along_axis(self.vertices, order, axis=1),
            self.sources,
            np.take_along_axis(self.weights, order[:, :, None], axis=1),
        )


def _expected(lengths: np.ndarray, rounds: int) -> float:
    """About how many triangles come of some with edges of these lengths (n, 3), in units of the longest allowed, that
    are halved at most ``rounds`` times each. Edges whose length is no number are not."""
    bounded = np.fmin(np.fmax(lengths, 1.0), 1e6)
    halvings = np.minimum(np.ceil(np.log2(np.sort(bounded, axis=1))), rounds)
    return float(np.exp2(halvings[:, 2] + halvings[:, 0]).sum())


def _halved(
    part: _Part, is_long: np.ndarray, lengths: np.ndarray, vertices: int
) -> tuple[_Part, np.ndarray, np.ndarray]:
    """The triangles that come of halving the marked edges (n, 3), of which each triangle has one or more; and sources
    and weights of the middles, which are the vertices from ``vertices`` on. lengths: (n, 3) of the edges."""
    ends = part.vertices[:, _ENDS]
    low, high = np.minimum(part.vertices, ends), np.maximum(part.vertices, ends)
    _, first, which = np.unique((low * vertices + high)[is_long], return_index=True, return_inverse=True)
    middles = np.zeros(is_long.shape, np.int64)
    middles[is_long] = vertices + which.reshape(-1)
    weights = 0.5 * (part.weights + part.weights[:, _ENDS])
    rows, edges = np.nonzero(is_long)
    sources, added = part.sources[rows[first]], weights[rows[first], edges[first]]
    counts = is_long.sum(axis=1)
    # Where it begins, the marked edges of a triangle come first.
    starts = np.argmax(is_long & ~is_long[:, [2, 0, 1]], axis=1)
    after = np.take_along_axis(lengths, ((starts + 1) % 3)[:, None], axis=1)[:, 0]
    first_is_shorter = np.take_along_axis(lengths, starts[:, None], axis=1)[:, 0] < after
    children = []
    for chosen, pattern in (
        (counts == 1, _IN_TWO),
        ((counts == 2) & first_is_shorter, _IN_THREE_FROM_FIRST),
        ((counts == 2) & ~first_is_shorter, _IN_THREE_FROM_LAST),
        (counts == 3, _IN_FOUR),
    ):
        some = np.flatnonzero(chosen)
        start = starts[some]
        order = (start[:, None] + np.arange(3)) % 3
        of_middles = np.take_along_axis(middles[some], order, axis=1)
        of_weights = np.take_along_axis(weights[some], order[:, :, None], axis=1)
        turned = part.rows(some).turned(start)
        vertices_of = np.concatenate([turned.vertices, of_middles], axis=1)
        weights_of = np.concatenate([turned.weights, of_weights], axis=1)
        children += [_Part(vertices_of[:, each], turned.sources, weights_of[:, each]) for each in pattern]
    return _Part.joined(children), sources, added
