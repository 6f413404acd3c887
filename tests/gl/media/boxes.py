# SPDX-License-Identifier: GPL-3.0-or-later
"""Boxes of even media in float64: single scattering by quadrature, and all orders by path tracing.

Nothing here is shared with the shaders. Media that overlap add up.
"""

from dataclasses import dataclass

import fog
import numpy as np
import scenes

from rppm_addon.scene import Material


@dataclass(frozen=True)
class Box:
    """A cube whose faces are upright, with its medium: coefficients of each channel, 1/m."""

    center: tuple[float, float, float] = (0.0, 0.0, 0.0)
    half: float = 1.0
    scattering: fog.Color = 1.0
    absorption: fog.Color = 0.0
    g: float = 0.0

    @property
    def extinction(self) -> np.ndarray:
        return np.broadcast_to(np.add(self.scattering, self.absorption), 3)

    def part(self) -> tuple[object, Material, np.ndarray]:
        """The box as a part of fog.scene_of."""
        return (
            scenes.box("box", self.half),
            fog.fog(self.scattering, self.absorption, self.g),
            scenes.placed(*self.center, 1.0),
        )

    def interval(self, origin: np.ndarray, way: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Distances, (...), at which rays come in and go out; the same where they pass by."""
        with np.errstate(divide="ignore"):
            inverse = 1.0 / np.where(way == 0.0, 1e-300, way)
        sides = [(np.asarray(self.center) + sign * self.half - origin) * inverse for sign in (-1.0, 1.0)]
        near = np.maximum(np.minimum(*sides).max(axis=-1), 0.0)
        return near, np.maximum(np.maximum(*sides).min(axis=-1), near)


def henyey_greenstein(g: float, cosine: np.ndarray) -> np.ndarray:
    """In 1/sr, by the cosine between the directions in which light travels before and after."""
    return (1.0 - g * g) / (4.0 * np.pi * (1.0 + g * g - 2.0 * g * cosine) ** 1.5)


def passed(boxes: list[Box], origin: np.ndarray, way: np.ndarray, length: np.ndarray) -> np.ndarray:
    """(..., 3) transmittance of segments."""
    depth = 0.0
    for box in boxes:
        near, far = box.interval(origin, way)
        inside = np.maximum(np.minimum(far, length) - np.minimum(near, length), 0.0)
        depth = depth + inside[..., None] * box.extinction
    return np.exp(-depth)


def single_scattering(boxes: list[Box], lamp: np.ndarray, origin: np.ndarray, way: np.ndarray) -> np.ndarray:
    """(..., 3) radiance along rays, (..., 3), by single scattering of a lamp of 1 W/sr: by Gauss and Legendre between
    the surfaces that a ray meets, by the angle at which the lamp sees its points."""
    ends = np.sort(np.stack([end for box in boxes for end in box.interval(origin, way)], axis=-1), axis=-1)
    nearest = ((lamp - origin) * way).sum(axis=-1)
    height = np.linalg.norm(lamp - origin - nearest[..., None] * way, axis=-1)
    nodes, weights = np.polynomial.legendre.leggauss(64)
    radiance = 0.0
    for low, high in zip(np.moveaxis(ends, -1, 0)[:-1], np.moveaxis(ends, -1, 0)[1:], strict=True):
        first, last = (np.arctan2(end - nearest, height) for end in (low, high))
        angles = first[..., None] + (last - first)[..., None] * 0.5 * (nodes + 1.0)
        along = nearest[..., None] + height[..., None] * np.tan(angles)
        points = origin + along[..., None] * way[..., None, :]
        to_lamp = lamp - points
        distance = np.linalg.norm(to_lamp, axis=-1)
        to_lamp /= distance[..., None]
        scattered = 0.0
        for box in boxes:
            near, far = box.interval(origin, way)
            inside = (along >= near[..., None]) & (along <= far[..., None])
            cosine = (to_lamp * way[..., None, :]).sum(axis=-1)
            phase = np.where(inside, henyey_greenstein(box.g, cosine), 0.0)
            scattered = scattered + phase[..., None] * np.broadcast_to(box.scattering, 3)
        light = passed(boxes, points, to_lamp, distance)
        light *= passed(
            boxes, np.broadcast_to(origin, points.shape), np.broadcast_to(way[..., None, :], points.shape), along
        )
        by_angle = (0.5 * (last - first) / height)[..., None] * weights
        radiance = radiance + (light * scattered * by_angle[..., None]).sum(axis=-2)
    return radiance


def _turned(way: np.ndarray, g: float, rng: np.random.Generator) -> np.ndarray:
    """Directions after scattering."""
    u = rng.random(len(way))
    cosine = 2.0 * u - 1.0
    if g:
        cosine = (1.0 + g * g - ((1.0 - g * g) / (1.0 - g + 2.0 * g * u)) ** 2) / (2.0 * g)
    sine, angle = np.sqrt(np.maximum(1.0 - cosine**2, 0.0)), 2.0 * np.pi * rng.random(len(way))
    helper = np.where(np.abs(way[:, :1]) < 0.6, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
    first = np.cross(helper, way)
    first /= np.linalg.norm(first, axis=-1, keepdims=True)
    second = np.cross(way, first)
    return (sine * np.cos(angle))[:, None] * first + (sine * np.sin(angle))[:, None] * second + cosine[:, None] * way


def traced_orders(
    box: Box, lamp: np.ndarray, origin: np.ndarray, way: np.ndarray, orders: int, seed: int = 1
) -> tuple[np.ndarray, np.ndarray]:
    """(orders,) mean radiance of rays, (n, 3) each, by the number of times that light was scattered, from once on, of a
    lamp of 1 W/sr; and (orders,) standard errors of sums of the first orders. The medium is gray."""
    rng = np.random.default_rng(seed)
    scattering, extinction = float(np.mean(box.scattering)), float(box.extinction[0])
    weight, sums = np.ones(len(way)), np.zeros((orders, len(way)))
    origin = np.broadcast_to(origin, way.shape)
    for order in range(orders):
        near, far = box.interval(origin, way)
        stopped = -np.expm1(-extinction * (far - near))
        distance = near - np.log1p(-rng.random(len(way)) * stopped) / extinction
        weight = weight * stopped * scattering / extinction
        origin = origin + distance[:, None] * way
        to_lamp = lamp - origin
        length = np.linalg.norm(to_lamp, axis=-1)
        to_lamp /= length[:, None]
        phase = henyey_greenstein(box.g, (to_lamp * way).sum(axis=-1))
        sums[order] = weight * phase * passed([box], origin, to_lamp, length)[:, 0] / length**2
        way = _turned(way, box.g, rng)
    totals = np.cumsum(sums, axis=0)
    return totals.mean(axis=1), totals.std(axis=1) / np.sqrt(len(way))


def escaping(box: Box, start: np.ndarray, count: int, seed: int = 1) -> tuple[float, float]:
    """The fraction of light from a point in a box, by analog walks, that leaves the box, and its standard error."""
    rng = np.random.default_rng(seed)
    way = rng.normal(size=(count, 3))
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    origin, extinction = np.broadcast_to(start, way.shape), float(box.extinction[0])
    albedo, escaped = float(np.mean(box.scattering)) / extinction, 0
    while len(way):
        distance = rng.exponential(1.0 / extinction, len(way))
        stays = distance < box.interval(origin, way)[1]
        escaped += int((~stays).sum())
        stays &= rng.random(len(way)) < albedo
        origin, way = (origin + distance[:, None] * way)[stays], _turned(way[stays], box.g, rng)
    fraction = escaped / count
    return fraction, float(np.sqrt(fraction * (1.0 - fraction) / count))


def collisions(box: Box, count: int, seed: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Places, (n, 3), at which a box scatters ``count`` paths that enter it from an even world, and the paths' numbers,
    (n,). The medium absorbs nothing; a path has 4 x volume / surface x scattering places on average."""
    rng = np.random.default_rng(seed)
    paths, axis, side = np.arange(count), rng.integers(0, 3, count), rng.choice([-1.0, 1.0], count)
    origin, way = rng.uniform(-box.half, box.half, (count, 3)), np.empty((count, 3))
    cosine, angle = np.sqrt(rng.random(count)), 2.0 * np.pi * rng.random(count)
    sine = np.sqrt(1.0 - cosine**2)
    origin[paths, axis], way[paths, axis] = side * box.half, -side * cosine
    way[paths, (axis + 1) % 3], way[paths, (axis + 2) % 3] = sine * np.cos(angle), sine * np.sin(angle)
    origin += np.asarray(box.center)
    places, numbers = [], []
    while len(way):
        distance = rng.exponential(1.0 / box.extinction[0], len(way))
        stays = distance < box.interval(origin, way)[1]
        origin, paths = (origin + distance[:, None] * way)[stays], paths[stays]
        way = _turned(way[stays], box.g, rng)
        places.append(origin)
        numbers.append(paths)
    return np.concatenate(places), np.concatenate(numbers)
