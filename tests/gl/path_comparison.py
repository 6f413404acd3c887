# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether the photon mapper's mean over independent seeds is what quadrature says a class of light paths shows."""

import dataclasses
import zlib
from pathlib import Path

import numpy as np
import pytest
from parity.comparison import write_pair
from path_classes import Case
from path_scenes import traced_only

from rppm_addon.integrator.camera_paths import final_gather
from rppm_addon.integrator.progressive import ProgressivePhotonMapper
from rppm_addon.scene import DirectLight, Scene

BLOCKS, SEEDS = 3, 12
"""Blocks along a side, independent seeds: of half as many, the noise of the noisiest block was told too small by
chance, once in some hundred tests."""
SHARPNESS = 0.05
"""Share of the mean that every test must be able to tell; most tell much less."""
ROUNDING = 5e-4
"""Relative error of float positions, of unit vectors in 2 x 16 bits, and of block means of the reference (measured
with twice the nodes: at most 3e-4)."""
OUTPUT = Path(__file__).parents[2] / "out" / "path_classes"


def render(mapper: ProgressivePhotonMapper, scene: Scene, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """(H, W, 3) radiance, and the mean over the iterations of the squares of both splat radii, m^2."""
    mapper.update(dataclasses.replace(scene, settings=scene.settings.with_values(seed=seed)))
    squares = []
    for _ in range(scene.settings.iterations):
        mapper.iterate()
        squares.append(np.square(mapper.splat_radii))
    return mapper.film.read_radiance()[..., :3].astype(np.float64), np.mean(squares, axis=0)


def gathered(case: Case, square: np.ndarray) -> np.ndarray:
    """(H, W, 3) what density estimation with splats of a mean ``square`` (2,) of both radii, m^2, converges to.

    The kernel 2 (1 - x^2) / pi over a disk of radius r has the second moment r^2 / 3 and the fourth r^4 / 6: so have
    its middle, taken by a third, and a ring of radius r / sqrt(2) by two thirds.
    """
    exact = case.expected(np.zeros(3))
    if case.gathers is None:
        return exact
    angle = 2 * np.pi * np.arange(5) / 5
    ring = np.sqrt(square[case.gathers] / 2) * np.stack([np.cos(angle), np.sin(angle)], -1) @ case.across
    return exact / 3 + np.mean([case.expected(offset) for offset in ring], axis=0) * 2 / 3


def blocks(pictures: np.ndarray) -> np.ndarray:
    """(..., H, W, 3) to (..., BLOCKS, BLOCKS), means of pixels and channels."""
    *outer, height, width, _ = pictures.shape
    shape = *outer, BLOCKS, height // BLOCKS, BLOCKS, width // BLOCKS, 3
    return pictures.reshape(shape).mean(axis=(-4, -2, -1))


def block_errors(by_seed: np.ndarray, level: np.ndarray) -> np.ndarray:
    """(BLOCKS, BLOCKS) standard errors of the mean over seeds of block means (seeds, BLOCKS, BLOCKS).

    The variance goes with the level, as that of counted photons does; what goes beyond is common to all blocks, for
    few seeds tell little of a single one, unless it is noisier than that.
    """
    variance = by_seed.var(axis=0, ddof=1)
    level = np.maximum(level, 0.1 * level.mean())
    return np.sqrt(np.maximum(level * np.mean(variance / level), variance) / len(by_seed))


def judge(name: str, pictures: np.ndarray, right: np.ndarray) -> None:
    """Assert that pictures (seeds, H, W, 3) have the mean and the block means of the right one (H, W, 3), by channel
    and block: they may differ by four standard errors and by rounding."""
    write_pair(name, pictures.mean(axis=0), right, OUTPUT)
    level, by_seed = blocks(right), blocks(pictures)
    errors = block_errors(by_seed, level)
    ratios = pictures.mean(axis=(1, 2)) / right.mean(axis=(0, 1))
    mean = ratios.mean(axis=0)
    # Splats reach over blocks: the seeds' own spread counts as well.
    spread = ratios.mean(axis=1).std(ddof=1) / np.sqrt(len(pictures))
    error = max(spread, np.sqrt((errors**2).mean()) / BLOCKS / level.mean())
    difference = by_seed.mean(axis=0) - level
    allowed = 4 * errors + ROUNDING * np.maximum(level, level.mean())
    assert 4 * error < SHARPNESS, f"{name}: too noisy to tell"
    assert np.abs(mean - 1).max() <= 4 * error + ROUNDING
    assert (np.abs(difference) <= allowed).all()


def gathering(case: Case, monkeypatch: pytest.MonkeyPatch, iterations: int | None) -> Case:
    """The case with final gather, nothing shared; where its last surface gets its light by the gathering ray, in so
    many iterations."""
    monkeypatch.setattr(final_gather, "REUSE_RADIUS", 0.0)
    settings = case.scene.settings
    changed = settings.with_values(use_final_gather=True, camera_path_length=settings.camera_path_length + 1)
    scene = dataclasses.replace(case.scene, settings=changed)
    if iterations is not None:  # seldom: what the rays look for is small
        traced_only(scene, iterations, 64 if settings.direct_light is DirectLight.RAYS else 2048)
        scene.settings.radius_scale = 10.0  # photons where the rays end have disks of a few centimeters
    return dataclasses.replace(case, scene=scene, gathers=case.gathers if iterations is None else None)


def compare(mapper: ProgressivePhotonMapper, name: str, case: Case) -> None:
    """Render a class, whose name tells its seeds, so that no two share their noise, and judge it."""
    first = zlib.crc32(name.encode()) & 0xFFFFFFF
    settings = case.scene.settings
    scene = dataclasses.replace(case.scene, settings=settings.with_values(iterations=-(-settings.iterations // 2)))
    renders = [render(mapper, scene, first + k) for k in range(SEEDS)]
    square = np.mean([square for _, square in renders], axis=0)
    right = gathered(case, square)
    pictures = np.array([picture for picture, _ in renders])
    finer = pictures.shape[1] // len(right)  # what is smooth across a pixel is as bright at its parts
    pictures = pictures.reshape(SEEDS, len(right), finer, len(right), finer, 3).mean(axis=(2, 4))
    judge(name, pictures, right)


def picture_by_seed(mapper, name: str, scene: Scene, seeds: int = SEEDS) -> np.ndarray:
    """(seeds, H, W, 3) radiance."""
    first = zlib.crc32(name.encode()) & 0xFFFFFFF
    return np.array([render(mapper, scene, first + k)[0] for k in range(seeds)])
