# SPDX-License-Identifier: GPL-3.0-or-later
"""Strands to tubes of few sides, the more the fewer strands there are.

The sides have the strand's girth, 2 pi r, so that the mean of their width over all directions is 2 r, as that of any
convex outline is its girth over pi (Cauchy). Of odd numbers of sides it varies least: of three by 7 percent. What is
shaded is round all the same (shaders/materials/round_shapes.glsl).
"""

import dataclasses
import functools
import math
from dataclasses import dataclass

import numpy as np

_MOST_SIDES, _LEAST_SIDES = (11, 7, 5), 3
_MANY_TRIANGLES = 1 << 17
"""Triangles of one object up to which its tubes have more than _LEAST_SIDES; they have as many as this allows."""
_TURN = math.radians(12.0)
"""By which a tube turns from one ring to the next at most, as far as the settings allow."""
_BEND = 0.1
"""Relative deviation of radii from a straight line beyond which rings are added."""
_BENT_STEPS = 4
MOST_TRIANGLES = 1 << 26
"""Most triangles of one object, some 6 GB on the device."""


@dataclass
class Strands:
    """Control points of strands, in the space of their object."""

    keys: np.ndarray
    """(keys, 3) float32 meters, strand after strand, from root to tip."""
    radii: np.ndarray
    """(keys,) float32 meters."""
    starts: np.ndarray
    """(strands + 1,) int32, the first key of each strand, and the end."""
    slots: np.ndarray
    """(strands,) int32, material slots."""
    smooth: bool = True
    """Whether they are Catmull-Rom splines, or else straight from key to key."""
    kept: np.ndarray | None = None
    """(strands before,) bool, which of them these are; None: all."""
    kept_keys: np.ndarray | None = None
    """(keys before,) bool, likewise."""


@dataclass
class Rings:
    """Where along their strands the rings of tubes lie, strand after strand."""

    starts: np.ndarray
    """(strands + 1,) int64, the first ring of each strand, and the end."""
    key: np.ndarray
    """(rings,) int32, the key before or at a ring."""
    after: np.ndarray
    """(rings,) int32, the key behind that on the same strand."""
    part: np.ndarray
    """(rings,) float32, 0 to 1, of the way from the one to the other."""

    @property
    def part_count(self) -> int:
        """Number of parts of all tubes, each from one ring to the next."""
        return len(self.key) - (len(self.starts) - 1)

    @functools.cached_property
    def sides(self) -> int:
        """Number of sides of each tube."""
        return next((n for n in _MOST_SIDES if 2 * n * self.part_count <= _MANY_TRIANGLES), _LEAST_SIDES)

    @property
    def triangle_count(self) -> int:
        """Number of triangles of all tubes."""
        return 2 * self.sides * self.part_count

    def per_vertex(self, of_rings: np.ndarray) -> np.ndarray:
        """(vertices, n) of values (rings, n)."""
        return np.repeat(of_rings, self.sides, axis=0)

    def of_keys(self, values: np.ndarray) -> np.ndarray:
        """(rings, n) of values (keys, n): linear between keys, as Cycles has attributes."""
        first = values.take(self.key, axis=0)
        return first + self.part[:, None] * (values.take(self.after, axis=0) - first)

    def of_strands(self, values: np.ndarray) -> np.ndarray:
        """(rings, n) of values (strands, n)."""
        return np.repeat(values, np.diff(self.starts), axis=0)


def usable(strands: Strands, farthest: float) -> Strands:
    """Without the strands that have a key that is not finite or farther off, or a single one; itself if all are good.
    Radii that are negative or not finite count as 0."""
    starts = strands.starts.astype(np.int64)
    counts = np.diff(starts)
    radii = strands.radii
    if len(radii) and not (radii.min() >= 0.0 and radii.max() < farthest):
        radii = np.where((radii >= 0.0) & (radii < farthest), radii, np.float32(0.0))
    keys, good = strands.keys, counts > 1
    if len(keys) and not (keys.min() > -farthest and keys.max() < farthest):  # false for NaN as well
        near = (np.abs(keys) < farthest).all(axis=1)
        good &= np.add.reduceat(~near, starts[:-1].clip(max=len(keys) - 1)) == 0
    if good.all():
        return strands if radii is strands.radii else dataclasses.replace(strands, radii=radii)
    kept = np.repeat(good, counts)
    ends = np.concatenate([[0], np.cumsum(counts[good])]).astype(np.int32)
    return Strands(keys[kept], radii[kept], ends, strands.slots[good], strands.smooth, good, kept)


def rings_of(strands: Strands, most: int) -> Rings:
    """Rings where tubes turn, so that splines have up to ``most`` parts from key to key."""
    starts = strands.starts.astype(np.int64)
    # Segments go from each key but the last of a strand to the next one.
    is_last = np.zeros(len(strands.keys), bool)
    is_last[starts[1:] - 1] = True
    if not strands.smooth:  # each segment has rings of its own, across it; what they leave open is closed
        key = np.repeat(np.flatnonzero(~is_last).astype(np.int32), 2)
        part = np.tile(np.float32([0.0, 1.0]), len(key) // 2)
        return Rings(2 * (starts - np.arange(len(starts))), key, key + 1, part)
    parts = _parts(strands, most)
    parts[is_last] = 1  # of the last key, the ring at the tip
    total = int(parts.sum())
    if total == len(parts):
        key, part = np.arange(total, dtype=np.int32), np.zeros(total, np.float32)
        ring_starts = starts
    else:
        ends = np.cumsum(parts)
        firsts = ends - parts
        key = np.repeat(np.arange(len(parts), dtype=np.int32), parts)
        step = np.arange(total, dtype=np.int32) - firsts.astype(np.int32).take(key)
        part = step.astype(np.float32) / parts.astype(np.float32).take(key)
        ring_starts = np.concatenate([firsts[starts[:-1]], ends[-1:]])
    after = key + 1
    tips = ring_starts[1:] - 1
    # Tips lie at the end of the segment before, where tangents are known.
    key[tips], part[tips] = key[tips] - 1, 1.0
    after[tips] = key[tips] + 1
    return Rings(ring_starts, key, after, part)


def _parts(strands: Strands, most: int) -> np.ndarray:
    """(keys,) int64, into how many parts the segment behind each key is divided."""
    keys = strands.keys
    if most <= 1 or len(keys) < 3:
        return np.ones(len(keys), np.int64)
    steps = np.zeros_like(keys)
    steps[:-1] = keys[1:] - keys[:-1]
    lengths = np.sqrt(np.einsum("ij,ij->i", steps, steps))
    cosine = np.ones(len(keys), np.float32)
    product = lengths[:-1] * lengths[1:]
    np.divide(np.einsum("ij,ij->i", steps[:-1], steps[1:]), product, out=cosine[1:], where=product > 0.0)
    turn = np.arccos(np.clip(cosine, -1.0, 1.0))  # at each key, between the segments before and behind it
    firsts = strands.starts[:-1]
    turn[firsts] = 0.0
    turn[strands.starts[1:] - 1] = 0.0
    # Half of the turn at either end; where a strand ends the spline turns by half as much again.
    whole = 0.5 * turn
    whole[:-1] += 0.5 * turn[1:]
    whole *= 1.5
    parts = np.ceil(whole / np.float32(_TURN)).astype(np.int64)
    bends = np.zeros(len(keys), bool)
    radii = strands.radii
    second = np.abs(radii[:-2] - 2.0 * radii[1:-1] + radii[2:]) > _BEND * np.maximum(radii[:-2], radii[2:])
    bends[1:-1] = second
    bends[firsts] = False
    bends[strands.starts[1:] - 1] = False
    bends[:-1] |= bends[1:]
    parts[bends] = np.maximum(parts[bends], _BENT_STEPS)
    return np.clip(parts, 1, most)


def _splines(strands: Strands, rings: Rings) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Places (rings, 3), tangents (rings, 3) of any length and radii (rings,) of rings, each float32."""
    keys, t = strands.keys, rings.part[:, None]
    curve = np.empty((len(keys), 4), np.float32)
    curve[:, :3], curve[:, 3] = keys, strands.radii
    one, two = curve.take(rings.key, axis=0), curve.take(rings.after, axis=0)
    if not strands.smooth:
        steps = two - one
        at = one + t * steps
        return at[:, :3], steps[:, :3], at[:, 3]
    lowest = np.zeros(len(keys), np.int32)
    lowest[strands.starts[:-1]] = 1
    before = rings.key - 1 + lowest.take(rings.key)  # a strand's first and last key count twice
    highest = np.zeros(len(keys), np.int32)
    highest[strands.starts[1:] - 1] = 1
    behind = rings.after + 1 - highest.take(rings.after)
    zero, three = curve.take(before, axis=0), curve.take(behind, axis=0)
    a, b, c = 0.5 * (two - zero), zero - 2.5 * one + 2.0 * two - 0.5 * three, 0.5 * (three - zero) + 1.5 * (one - two)
    at = one + t * (a + t * (b + t * c))
    tangents = (a + t * (2.0 * b + 3.0 * t * c))[:, :3]
    return at[:, :3], tangents, np.maximum(at[:, 3], np.float32(0.0))


def _unit(vectors: np.ndarray) -> np.ndarray:
    """Unit vectors (n, 3), 0 where there is no direction; in place."""
    squares = np.einsum("ij,ij->i", vectors, vectors)
    vectors *= np.where(squares > 1e-30, 1.0 / np.sqrt(np.maximum(squares, 1e-30)), 0.0).astype(np.float32)[:, None]
    return vectors


def _across(tangents: np.ndarray, turns: np.ndarray) -> np.ndarray:
    """(n, 3) unit vectors across unit tangents (n, 3), turned about them by angles (n,)."""
    s = np.where(tangents[:, 2] >= 0.0, np.float32(1.0), np.float32(-1.0))
    x, y, z = tangents.T
    a = -1.0 / (s + z)
    c = x * y * a
    # Duff et al., JCGT 2017.
    one = np.stack([1.0 + s * x * x * a, s * c, -s * x], axis=1)
    other = np.stack([c, s + y * y * a, -y], axis=1)
    return np.cos(turns)[:, None] * one + np.sin(turns)[:, None] * other


def _carried(tangents: np.ndarray, starts: np.ndarray, roots: np.ndarray | None) -> np.ndarray:
    """(rings, 3) unit vectors across unit tangents, carried from ring to ring without twist. roots: as in
    tube_vertices."""
    counts = np.diff(starts)
    order = np.argsort(-counts, kind="stable")
    firsts, lengths = starts[:-1][order], counts[order]
    # Each strand begins at an angle of its own: what outlines of tubes are too wide or too narrow evens out.
    turns = (np.arange(len(counts), dtype=np.float32) * np.float32(2.399963)) % np.float32(2.0 * math.pi)
    result = np.empty_like(tangents)
    tangent = tangents.take(firsts, axis=0)
    if roots is None:
        now = _across(tangent, turns[order])
    else:
        now = _laid_across(roots.take(order, axis=0), tangent, turns[order])
    result[firsts] = now
    active = len(firsts)
    for step in range(1, int(lengths[0]) if len(lengths) else 0):
        while lengths[active - 1] <= step:
            active = int(np.searchsorted(-lengths, -step))
        places = firsts[:active] + step
        tangent = tangents.take(places, axis=0)
        now = _laid_across(now[:active], tangent, turns)
        result[places] = now
    return result


def _laid_across(vectors: np.ndarray, tangents: np.ndarray, turns: np.ndarray) -> np.ndarray:
    """(n, 3) unit vectors across unit tangents (n, 3), those next to vectors (n, 3); at angles where there are none."""
    vectors = vectors - np.einsum("ij,ij->i", vectors, tangents)[:, None] * tangents
    squares = np.einsum("ij,ij->i", vectors, vectors)
    if squares.min() < 1e-4:  # a sharp bend right into the vector
        lost = np.flatnonzero(squares < 1e-4)
        vectors[lost], squares[lost] = _across(tangents[lost], turns[lost]), 1.0
    vectors *= (1.0 / np.sqrt(squares))[:, None]
    return vectors


def tube_vertices(strands: Strands, rings: Rings, roots: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Vertices of tubes and their unit normals, each (vertices, 3) float32, ring after ring, right-handed about the way
    to the tip. roots: (strands, 3) normals of the first vertices of strands at another time, which they follow."""
    at, tangents, radii = _splines(strands, rings)
    tangents = _unit(tangents)
    still = np.flatnonzero(~tangents.any(axis=1))
    if len(still):  # keys at one place
        tangents[still] = _unit(strands.keys[rings.after[still]] - strands.keys[rings.key[still]])
        tangents[still[~tangents[still].any(axis=1)]] = (0.0, 0.0, 1.0)
    one = _carried(tangents, rings.starts, roots)
    other = np.cross(tangents, one)
    normals = np.empty((len(at), rings.sides, 3), np.float32)
    for side in range(rings.sides):
        angle = 2.0 * math.pi * side / rings.sides
        np.multiply(one, np.float32(math.cos(angle)), out=normals[:, side])
        normals[:, side] += np.float32(math.sin(angle)) * other
    positions = normals * (np.float32(_reach(rings.sides)) * radii)[:, None, None]
    positions += at[:, None, :]
    return positions.reshape(-1, 3), normals.reshape(-1, 3)


def _reach(sides: int) -> float:
    """How far from its middle the corners of a polygon of girth 2 pi lie."""
    return math.pi / (sides * math.sin(math.pi / sides))


def _pattern(sides: int) -> np.ndarray:
    """(6 * sides,) int32, the vertices of the triangles between two rings.

    Of each side two triangles, first the corner that is alone on its ring, then its neighbor along the strand: from
    their order shaders know which way the tip is.
    """
    result: list[int] = []
    for side in range(sides):
        right = (side + 1) % sides
        result += [sides + side, side, right, right, sides + right, sides + side]
    return np.array(result, np.int32)


def tube_triangles(rings: Rings) -> np.ndarray:
    """(triangles, 3) int32 vertices of the triangles of tubes, those of even number with their lone corner toward the
    tip."""
    goes_on = np.ones(len(rings.key), bool)
    goes_on[rings.starts[1:] - 1] = False
    first = np.flatnonzero(goes_on).astype(np.int32) * np.int32(rings.sides)
    return (first[:, None] + _pattern(rings.sides)).reshape(-1, 3)
