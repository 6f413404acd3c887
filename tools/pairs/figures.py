# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers that say how far two renderers' pictures of one file are apart, beyond the noise of both."""

from dataclasses import dataclass

import numpy as np

from rppm_addon.pictures import standard_view
from tests.parity.features.flip import flip

BLOCK = 8
"""Pixels a side of the blocks whose means are compared."""
OFF = 0.1
"""Share of a block's level by which it may differ beyond noise until it counts as off."""
SIGMAS = 4.0
"""Standard errors that are taken for noise, as by the parity tests."""
DARKEST = 0.1
"""Share of the picture's mean that is the least level of a block, as what is darker is not looked at."""


@dataclass(frozen=True)
class Figures:
    """The differences of a pair of pictures; NaN where Cycles' is black."""

    mean: float
    """RPPM's mean over Cycles', of all channels together."""
    error: float
    """Standard error of ``mean``."""
    median: float
    """Median over the blocks of the ratio of their means, which a few bright spots do not move."""
    off: float
    """Share of the blocks that are 10 % off beyond noise, in radiance or in alpha."""
    flip: float
    """Mean FLIP of the pictures, each brought to the same brightness."""
    flip_of_noise: float
    """Mean FLIP of Cycles' two pictures."""


def figures_of(ours: np.ndarray, theirs: np.ndarray) -> Figures:
    """The figures of two pictures a renderer: (2, H, W, 4) premultiplied radiance and alpha, of two seeds each."""
    light = [(_blocks(pictures[..., :3]).mean(axis=-1)) for pictures in (ours, theirs)]
    cover = [_blocks(pictures[..., 3:]).mean(axis=-1) for pictures in (ours, theirs)]
    off = _is_off(*light, max(DARKEST * float(np.abs(light[1]).mean()), 1e-9)) | _is_off(*cover, DARKEST)
    squared_error = sum(_squared_error(blocks) for blocks in light)
    means = [float(blocks.mean()) for blocks in light]
    exposure = exposure_of(theirs.mean(axis=0))
    shown = [[shown_picture(picture, exposure) for picture in (*pictures, pictures.mean(axis=0))]
             for pictures in (ours, theirs)]  # fmt: skip
    with np.errstate(all="ignore"):
        ratios = light[0].mean(axis=0) / light[1].mean(axis=0)
        error = float(np.sqrt(squared_error.sum()) / squared_error.size / np.abs(np.float64(means[1])))
        mean = float(np.float64(means[0]) / np.float64(means[1]))
    known = ratios[np.isfinite(ratios)]
    return Figures(
        mean,
        error,
        float(np.median(known)) if known.size else float("nan"),
        float(off.mean()),
        float(flip(shown[1][2], shown[0][2]).mean()),
        float(flip(shown[1][0], shown[1][1]).mean()),
    )


def _blocks(pictures: np.ndarray) -> np.ndarray:
    """(N, H, W, C) to (N, rows, columns, C): means of blocks; what is beyond the last whole ones is left out."""
    count, height, width, channels = pictures.shape
    side = min(BLOCK, height, width)
    rows, columns = height // side, width // side
    cut = pictures[:, : rows * side, : columns * side].astype(np.float64)
    return cut.reshape(count, rows, side, columns, side, channels).mean(axis=(2, 4))


def _squared_error(blocks: np.ndarray) -> np.ndarray:
    """(rows, columns) squared standard errors of the means of two seeds; neighbors are asked too, two tell little."""
    variance = np.nan_to_num(blocks.var(axis=0, ddof=1), posinf=0.0) / len(blocks)  # what is not finite is off anyway
    padded = np.pad(variance, 1, mode="edge")
    rows, columns = variance.shape
    near = sum(padded[i : i + rows, j : j + columns] for i in range(3) for j in range(3)) / 9.0
    return np.maximum(near, variance)


def _is_off(ours: np.ndarray, theirs: np.ndarray, least: float) -> np.ndarray:
    """(rows, columns) bool: the blocks (2, rows, columns) that differ by OFF and noise."""
    noise = SIGMAS * np.sqrt(_squared_error(ours) + _squared_error(theirs))
    level = np.maximum(np.abs(theirs.mean(axis=0)), least)
    difference = np.abs(ours.mean(axis=0) - theirs.mean(axis=0))
    return ~(difference <= OFF * level + noise)  # what is not a number is off


def exposure_of(picture: np.ndarray) -> float:
    """The factor that brings a picture's middle brightness into view."""
    luminance = picture[..., :3] @ (0.2126, 0.7152, 0.0722)
    lit = luminance[np.isfinite(luminance) & (luminance > 0.0)]
    return 0.3 / float(np.percentile(lit, 60)) if lit.size else 1.0


def shown_picture(picture: np.ndarray, exposure: float) -> np.ndarray:
    """(H, W, 3) from 0 to 1 in sRGB: a picture through the Standard view, over black, row 0 at the bottom."""
    lit = np.nan_to_num(picture[..., :3] * exposure, nan=0.0, posinf=1e6, neginf=0.0)
    shown = np.concatenate([lit, np.ones_like(picture[..., :1])], axis=-1).astype(np.float32)
    return standard_view(shown)[..., :3].astype(np.float64) / 255.0
