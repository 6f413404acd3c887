# SPDX-License-Identifier: GPL-3.0-or-later
"""Style, colors and axes that all figures share."""

import matplotlib

matplotlib.use("Agg")
import numpy as np
from matplotlib.ticker import FuncFormatter, NullLocator

STYLE = {
    "figure.dpi": 110,
    "figure.constrained_layout.use": True,
    "font.size": 9,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.6,
    "legend.frameon": False,
}
COLORS = ("#1f6fb4", "#e07b00", "#2f9e44", "#c92a2a", "#7048a8", "#8a5a3b", "#d6579a", "#5f6b76")


def plain(value: float, _: int = 0) -> str:
    """1000 as 1k, 1000000 as 1M, 0.01 as it is."""
    for size, letter in ((1e6, "M"), (1e3, "k")):
        if value >= size:
            return f"{value / size:.4g}{letter}"
    return f"{value:.4g}"


def logarithmic(axis, base: int = 10) -> None:
    """Plain numbers along a logarithmic axis (axes.xaxis or axes.yaxis)."""
    getattr(axis.axes, f"set_{axis.axis_name}scale")("log", base=base)
    axis.set_major_formatter(FuncFormatter(plain))
    if base != 10:
        axis.set_minor_locator(NullLocator())
        return

    def minor(value: float, _: int) -> str:
        low, high = axis.get_view_interval()
        decades = np.log10(high / low)
        named = "23456789" if decades < 0.7 else "235" if decades < 1.4 else "25" if decades < 1.8 else ""
        return plain(value) if f"{value:.0e}"[0] in named else ""

    axis.set_minor_formatter(FuncFormatter(minor))


def label_of(scene: dict) -> str:
    triangles = float(f"{scene['triangles']:.3g}")
    return f"{scene['scene']} ({plain(triangles)})"
