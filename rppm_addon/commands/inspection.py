# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of what rays cost in the deep cubemap."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from ..pictures import Placement, write_exr
from ..scene.scene import Scene
from ..scene.settings import CUBEMAP_COSTS
from .picture_files import write_png

# From dark blue over green to yellow: brightness grows all the way, so that gray printers show it too.
_COLORS = np.array([[0.05, 0.03, 0.25], [0.20, 0.25, 0.55], [0.12, 0.50, 0.56], [0.30, 0.72, 0.40], [0.99, 0.91, 0.15]])


def write_inspection(path: Path, costs: np.ndarray, quantity: str, scene: Scene) -> float:
    """Write one quantity in false colors (.png) or all as they are (.exr); returns what the last color stands for.

    ``costs``: (height, width, 4) of CUBEMAP_COSTS. Raises PictureError.
    """
    values = costs[..., CUBEMAP_COSTS.index(quantity)]
    greatest = max(float(np.percentile(values, 99.9)), 1.0)
    if path.suffix == ".png":
        write_png(path, false_colors(values / greatest))
    else:
        camera = scene.camera
        x, y, _, _ = camera.region
        opaque = np.concatenate([costs[..., :3], np.ones_like(costs[..., :1])], axis=-1)
        layers = {name.capitalize(): costs[..., index] for index, name in enumerate(CUBEMAP_COSTS)}
        write_exr(path, opaque, layers, None, Placement(camera.width, camera.height, x, y))
    return greatest


def false_colors(values: np.ndarray) -> np.ndarray:
    """(..., 3) uint8 sRGB of values from 0 to 1; greater ones get the last color."""
    places = np.linspace(0.0, 1.0, len(_COLORS))
    channels = [np.interp(values, places, _COLORS[:, channel]) for channel in range(3)]
    return np.rint(255.0 * np.stack(channels, axis=-1)).astype(np.uint8)


def inspection_lines(costs: np.ndarray, counts: Mapping[str, int], memory: Mapping[str, int]) -> list[str]:
    """List the lines to print: each quantity's mean, median, 99.9th percentile and maximum, counts, bytes by buffer."""
    lines = [f"{'per ray':<10}{'mean':>9}{'median':>9}{'99.9 %':>9}{'most':>9}"]
    for index, name in enumerate(CUBEMAP_COSTS):
        values = costs[..., index]
        numbers = (values.mean(), np.median(values), np.percentile(values, 99.9), values.max())
        lines.append(f"{name:<10}" + "".join(f"{number:>9.1f}" for number in numbers))
    lines += [f"{name.replace('_', ' '):<40}{count:>14,}" for name, count in counts.items()]
    lines += [f"{name:<40}{size / 2**20:>10.1f} MiB" for name, size in memory.items()]
    return lines
