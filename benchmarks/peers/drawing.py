# SPDX-License-Identifier: GPL-3.0-or-later
"""Plots of error against seconds, and a sheet of the pictures."""

from pathlib import Path

import matplotlib
import numpy as np
import PIL.Image
import PIL.ImageDraw

from .environments import ROOT
from .methods import OWN
from .metrics import displayed
from .results import Results, SceneResult

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402 (after the choice of where to draw)

_LABEL = 14


def draw_curves(scene: SceneResult, path: Path) -> None:
    """Error against seconds of all methods, both in logarithms."""
    figure, axes = pyplot.subplots(figsize=(7.0, 4.5), layout="constrained")
    for curve in scene.curves:
        seconds = [point.seconds for point in curve.points]
        errors = [point.relative_mse for point in curve.points]
        width, order = (2.5, 3) if curve.method == OWN else (1.2, 2)
        axes.loglog(seconds, errors, marker="o", label=curve.label, linewidth=width, zorder=order)
    axes.axhline(scene.agreement.floor, color="gray", linestyle=":", label="noise of the reference")
    axes.set(title=scene.title, xlabel="seconds", ylabel="relative mean square error")
    axes.grid(True, which="both", alpha=0.25)
    axes.legend(fontsize=8)
    figure.savefig(path, dpi=110)
    pyplot.close(figure)


def draw_sheet(results: Results, mark: float, path: Path) -> None:
    """A row a scene, a column a method, the reference last, each at the scene's exposure."""
    size = results.resolution
    columns = list(dict.fromkeys(curve.label for scene in results.scenes for curve in scene.curves))
    height = size + _LABEL
    sheet = PIL.Image.new("RGB", ((len(columns) + 1) * size, len(results.scenes) * height), (24, 24, 24))
    draw = PIL.ImageDraw.Draw(sheet)
    for row, scene in enumerate(results.scenes):
        found = {}
        for curve in scene.curves:
            point = curve.point(mark)
            if point is not None:
                found[columns.index(curve.label)] = (point.file, f"{curve.label}, {point.seconds:.1f} s")
        found[len(columns)] = (scene.reference_file, "reference")
        for column, (file, label) in found.items():
            if not (ROOT / file).exists():
                continue
            levels = np.round(255.0 * displayed(np.load(ROOT / file), scene.exposure)).astype(np.uint8)
            sheet.paste(PIL.Image.fromarray(levels), (column * size, row * height))
            draw.text((column * size + 3, row * height + size + 1), label, fill=(220, 220, 220))
    sheet.save(path)
