# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether two engines' pictures of a scene agree, judged by noise estimated from independent seeds."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image

BLOCK = 8
OUTPUT = Path(__file__).parents[2] / "out" / "parity"


@dataclass(frozen=True)
class Tolerance:
    """Systematic differences allowed on top of noise, as shares of radiance."""

    mean: float = 0.015
    """Difference of the mean over the region, noise included."""
    block: float = 0.03
    """Difference of a block's mean, on top of four standard errors."""
    mode: float = 0.01
    """Amplitude of a slow cosine over the picture, on top of three standard errors."""


CONVERGED = Tolerance()
CAUSTIC = Tolerance(mean=0.03, block=0.09, mode=0.03)


def block_means(pictures: np.ndarray) -> np.ndarray:
    """(..., H, W, 3) to (..., H / 8, W / 8), the mean over 8x8 pixels and the three channels."""
    *outer, height, width, _ = pictures.shape
    return pictures.reshape(*outer, height // BLOCK, BLOCK, width // BLOCK, BLOCK, 3).mean(axis=(-4, -2, -1))


def _smooth(values: np.ndarray) -> np.ndarray:
    """Mean over the 3x3 neighbors: few seeds tell a block's variance only together with its neighbors'."""
    padded = np.pad(values, 1, mode="edge")
    rows, columns = values.shape
    return sum(padded[i : i + rows, j : j + columns] for i in range(3) for j in range(3)) / 9.0


def mean_variance(blocks: np.ndarray) -> np.ndarray:
    """Squared standard error of the mean over the seeds (axis 0), for each block."""
    if len(blocks) == 1:
        return np.zeros(blocks.shape[1:])  # a closed form
    return _smooth(blocks.var(axis=0, ddof=1)) / len(blocks)


def _modes(shape: tuple[int, int]) -> list[tuple[str, np.ndarray]]:
    """The slowest cosines over the blocks, at most one period across."""
    rows, columns = shape
    y = (np.arange(rows) + 0.5) / rows
    x = (np.arange(columns) + 0.5) / columns
    found = []
    for i in range(3):
        for j in range(3):
            if i + j > 0:
                wave = np.outer(np.cos(np.pi * i * y), np.cos(np.pi * j * x))
                found.append((f"({i},{j})", wave / (wave**2).sum()))
    return found


def compare(
    name: str, rppm: np.ndarray, reference: np.ndarray, tolerance: Tolerance, region: np.ndarray | None = None
) -> None:
    """Write the pair as a PNG, print the figures, and assert that the pictures agree.

    rppm, reference: (seeds, H, W, 3), one seed for a closed form. region: (H / 8, W / 8) bool,
    blocks whose mean is looked at as well as that of the picture. A mean may differ by
    tolerance.mean in each channel, which its noise must be well below; each block by
    tolerance.block and four standard errors; and the differences may hold no slow wave above
    tolerance.mode and three standard errors.
    """
    write_pair(name, rppm.mean(axis=0), reference.mean(axis=0))
    a, b = block_means(rppm), block_means(reference)
    difference = a.mean(axis=0) - b.mean(axis=0)
    squared_error = mean_variance(a) + mean_variance(b)
    level = b.mean(axis=0)
    regions = {"all": np.ones(level.shape, bool)} | ({"region": region} if region is not None else {})
    means = {}
    for label, chosen in regions.items():
        scale = level[chosen].mean()
        assert chosen.any() and scale > 0, f"{name}: the reference is black"
        pixels = np.kron(chosen, np.ones((BLOCK, BLOCK), bool))
        by_channel = rppm.mean(axis=0)[pixels].mean(axis=0) / reference.mean(axis=0)[pixels].mean(axis=0)
        means[label] = by_channel, np.sqrt(squared_error[chosen].sum()) / chosen.sum() / scale
    allowed = tolerance.block * np.maximum(level, 0.1 * level.mean())
    excess = (np.abs(difference) - 4.0 * np.sqrt(squared_error)) / allowed
    worst = np.unravel_index(np.argmax(excess), excess.shape)
    waves = []
    for wave_name, wave in _modes(level.shape):
        amplitude = (wave * difference).sum() / level.mean()
        error = np.sqrt((wave**2 * squared_error).sum()) / level.mean()
        waves.append((abs(amplitude) - 3.0 * error, wave_name, amplitude, error))
    wave = max(waves)
    print(f"\n{name}:")
    for label, (ratios, error) in means.items():
        print(f"  mean of {label} by channel {np.round(ratios, 4)} +- {error:.4f} (allowed {tolerance.mean})")
    print(
        f"  worst block {worst}: {level[worst]:.4g} {difference[worst]:+.2g} +- {np.sqrt(squared_error[worst]):.2g}; "
        f"strongest slow wave {wave[1]}: {wave[2]:+.2%} +- {wave[3]:.2%}"
    )
    for label, (ratios, error) in means.items():
        assert error < tolerance.mean / 2, f"{name}: the mean of {label} is too noisy to tell ({error:.4f})"
        assert np.abs(ratios - 1.0).max() <= tolerance.mean, f"{name}: the mean of {label} is off by {ratios - 1.0}"
    assert excess[worst] <= 1.0, f"{name}: block {worst} of {level[worst]:.4g} differs by {difference[worst]:+.4g}"
    assert wave[0] <= tolerance.mode, f"{name}: the differences have structure, a wave {wave[1]} of {wave[2]:+.2%}"


def write_pair(name: str, rppm: np.ndarray, reference: np.ndarray, folder: Path = OUTPUT) -> None:
    """RPPM | reference | difference (gray is none, full range is a fifth of white) to out/parity/ or a folder."""
    white = np.percentile(reference, 99) or 1.0

    def shown(values: np.ndarray) -> np.ndarray:
        return np.clip(values / white, 0.0, 1.0) ** (1 / 2.2)

    difference = np.clip(0.5 + 2.5 * (rppm - reference) / white, 0.0, 1.0)
    picture = np.concatenate([shown(rppm), shown(reference), difference], axis=1)[::-1]
    folder.mkdir(parents=True, exist_ok=True)
    image = Image.fromarray(np.round(255 * picture).astype(np.uint8))
    image.resize((4 * image.width, 4 * image.height), Image.Resampling.NEAREST).save(folder / f"{name}.png")
