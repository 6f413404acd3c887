# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the coefficients of Hosek and Wilkie's sky in Cycles' renders.

    python -m tests.parity.skies.measure_hosek_wilkie

Writes rppm_addon/materials/sky_hosek_wilkie.npz, in about five minutes. For each whole turbidity and for albedo 0 and
1, A, B, E and H are first found at each elevation alone, then as polynomials at all elevations together, by Levenberg
and Marquardt's method; C, D, F, G and I are linear and solved for within (variable projection). Between whole
turbidities and albedos A, B, E and H are linear, as Cycles interpolates them, and only the others are solved for.
Differences are weighted by what single precision leaves of a value.
"""

from collections.abc import Callable
from pathlib import Path

import numpy as np

from rppm_addon.materials.colorimetry import XYZ_TO_REC709
from rppm_addon.materials.sky import hosek_wilkie as sky_hosek_wilkie
from rppm_addon.materials.sky.hosek_wilkie import ALBEDOS, ELEVATION_NODES, LOWEST_COSINE, TURBIDITIES, terms
from rppm_addon.scene.sky import Sky

from .skies import panoramas

PIXELS = 900
SINGLE_PRECISION = 6e-8
STARTS = [
    (-1.1, -0.3, -3.0, 0.6),
    (-1.0, -0.1, -1.0, 0.4),
    (-1.1, -0.2, -0.3, 0.67),
    (-1.1, -0.2, 0.1, 0.65),
    (-1.05, -0.2, -20.0, 0.7),
]
LARGEST = np.array([np.inf, 20.0, 60.0, 1.5])
WITHIN = slice(1, None)
"""Elevations at which A, B, E and H are found; at 0 they are carried on to."""
QUINTIC = np.vander(2.0 * ELEVATION_NODES - 1.0, 6)

Pixels = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]
"""Cosine to the zenith (n,), angle to the sun (n,), XYZ (n, 3) and its noise (n, 3)."""


def _render() -> dict[tuple[int, int, int], Pixels]:
    """By the indices of turbidity, albedo and elevation."""
    places, skies = [], []
    for index in np.ndindex(len(TURBIDITIES), len(ALBEDOS), len(ELEVATION_NODES)):
        elevation = ELEVATION_NODES[index[2]] ** 3 * np.pi / 2
        sun = (0.0, float(np.cos(elevation)), float(np.sin(elevation)))
        turbidity, albedo = float(TURBIDITIES[index[0]]), ALBEDOS[index[1]]
        places.append(index)
        skies.append(Sky("HOSEK_WILKIE", sun_direction=sun, turbidity=turbidity, ground_albedo=albedo))
    to_xyz = np.linalg.inv(XYZ_TO_REC709).T
    found = {}
    for index, sky, (radiance, directions) in zip(places, skies, panoramas(skies)):
        seen = np.flatnonzero((radiance > 0.0).all(axis=1))  # Cycles clips the others
        seen = np.random.default_rng(3).permutation(seen)[:PIXELS]
        xyz = radiance[seen] @ to_xyz
        noise = SINGLE_PRECISION * np.abs(xyz) @ np.abs(XYZ_TO_REC709).T @ np.abs(to_xyz)
        to_sun = np.arccos(np.clip(directions[seen] @ np.array(sky.sun_direction), -1.0, 1.0))
        found[index] = np.maximum(directions[seen, 2], LOWEST_COSINE), to_sun, xyz, noise
    return found


def _linear(shape: np.ndarray, pixels: Pixels, channel: int) -> tuple[np.ndarray, np.ndarray]:
    """The five linear coefficients, and the differences in units of noise."""
    cosine, to_sun, value, noise = pixels
    parts = terms(shape, cosine, to_sun) / noise[:, channel, None]
    value = value[:, channel] / noise[:, channel]
    linear = np.linalg.lstsq(parts, value, rcond=None)[0]
    return linear, parts @ linear - value


def _minimize(difference: Callable, slope: Callable, start: np.ndarray) -> tuple[np.ndarray, float]:
    """Where the differences' squares are least, and the root of their mean there."""
    place, now, damping = start, difference(start), 1e-3
    for step in range(60):
        jacobian = slope(place, now)
        scale = np.linalg.norm(jacobian, axis=0) + 1e-30
        left, values, right = np.linalg.svd(jacobian / scale, full_matrices=False)
        along, before = left.T @ now, now @ now
        for _ in range(14):
            tried = place - right.T @ (values / (values**2 + damping) * along) / scale
            found = difference(tried)
            if found is not None and found @ found < before:
                break
            damping = max(5.0 * damping, 1e-12)
        else:
            break
        place, now, damping = tried, found, damping / 10.0
        if before - now @ now < 1e-3 * before and step > 25:
            break
    return place, float(np.sqrt(now @ now / len(now)))


def _slopes(shape: np.ndarray, pixels: Pixels, channel: int) -> np.ndarray:
    """(n, 4) by central differences."""
    steps = 1e-5 * np.maximum(np.abs(shape), 0.1)
    ahead = [_linear(shape + step, pixels, channel)[1] for step in np.diag(steps)]
    behind = [_linear(shape - step, pixels, channel)[1] for step in np.diag(steps)]
    return (np.array(ahead) - np.array(behind)).T / (2.0 * steps)


def _alone(pixels: Pixels, channel: int, starts: list) -> np.ndarray:
    """A, B, E and H at one elevation."""

    def difference(shape: np.ndarray) -> np.ndarray | None:
        return _linear(shape, pixels, channel)[1] if np.all(np.abs(shape) < LARGEST) else None

    def slope(shape: np.ndarray, _: np.ndarray) -> np.ndarray:
        return _slopes(shape, pixels, channel)

    best = None
    for start in starts:
        found = _minimize(difference, slope, np.array(start, np.float64))
        if best is None or found[1] < best[1]:
            best = found
        if best[1] < 5.0:
            break
    return best[0]


def _robust_quintic(values: np.ndarray) -> np.ndarray:
    """(6,) of the quintic through most of the values."""
    weights = np.ones(len(values))
    for _ in range(15):
        quintic = np.linalg.lstsq(QUINTIC[WITHIN] * weights[:, None], values * weights, rcond=None)[0]
        off = np.abs(QUINTIC[WITHIN] @ quintic - values)
        weights = 1.0 / (1.0 + (off / (3.0 * np.median(off) + 3e-6)) ** 2)
    return quintic


def _together(pixels: list[Pixels], channel: int, start: np.ndarray) -> tuple[np.ndarray, float]:
    """(6, 4) quintics of A, B, E and H, and the differences that stay, in units of noise."""
    basis = QUINTIC[WITHIN]

    def difference(quintics: np.ndarray) -> np.ndarray | None:
        shapes = basis @ quintics.reshape(6, 4)
        if np.any(np.abs(shapes) >= LARGEST):
            return None
        return np.concatenate([_linear(shape, seen, channel)[1] for shape, seen in zip(shapes, pixels)])

    def slope(quintics: np.ndarray, _: np.ndarray) -> np.ndarray:
        shapes = basis @ quintics.reshape(6, 4)
        rows = [
            np.einsum("k,nj->nkj", powers, _slopes(shape, seen, channel)).reshape(-1, 24)
            for powers, shape, seen in zip(basis, shapes, pixels)
        ]
        return np.concatenate(rows)

    found, error = _minimize(difference, slope, start.reshape(-1))
    return found.reshape(6, 4), error


def measure() -> np.ndarray:
    """Coefficients (turbidities, albedos, elevations, 3, 9), float64."""
    pixels = _render()
    count = len(ELEVATION_NODES)
    quintics = np.zeros((10, 2, 3, 6, 4))
    for i, j in np.ndindex(10, 2):
        seen = [pixels[2 * i, 2 * j, k] for k in range(1, count)]
        errors = []
        for channel in range(3):
            shapes = []
            for k, at in enumerate(seen):
                near = shapes[-1:] + ([QUINTIC[k + 1] @ quintics[i - 1, j, channel]] if i > 0 else [])
                shapes.append(_alone(at, channel, near[::-1] + STARTS))
            starts = [np.stack([_robust_quintic(values) for values in np.transpose(shapes)], axis=1)]
            starts += [quintics[i - 1, j, channel]] if i > 0 else []
            starts += [quintics[i, 0, channel]] if j > 0 else []
            fits = [_together(seen, channel, start) for start in starts]
            quintics[i, j, channel], error = min(fits, key=lambda fit: fit[1])
            errors.append(error)
        print(f"turbidity {i + 1}, albedo {j}: differences are {np.round(errors, 1)} of the noise", flush=True)
    table = np.zeros((len(TURBIDITIES), len(ALBEDOS), count, 3, 9))
    shapes = np.einsum("kp,ijcpq->ijkcq", QUINTIC, quintics)
    for i, j, k, channel in np.ndindex(table.shape[:4]):
        ends = 0.5 * (shapes[i // 2, :, k, channel] + shapes[(i + 1) // 2, :, k, channel])
        shape = (1.0 - ALBEDOS[j]) * ends[0] + ALBEDOS[j] * ends[1]
        table[i, j, k, channel] = [*shape, *_linear(shape, pixels[i, j, k], channel)[0]]
    return table


if __name__ == "__main__":
    path = Path(sky_hosek_wilkie.__file__).with_name("sky_hosek_wilkie.npz")
    np.savez_compressed(path, coefficients=measure().astype(np.float32))
