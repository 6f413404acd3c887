# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the estimator's figures."""

import matplotlib.pyplot as plt
import numpy as np

from .drawing import COLORS, label_of, logarithmic, plain

_COLUMNS = 4


def _panels(scenes: list[dict]):
    """A figure with a panel for each scene: the figure and (axes, scene) pairs."""
    columns = min(_COLUMNS, len(scenes))
    rows = -(-len(scenes) // columns)
    figure, panels = plt.subplots(rows, columns, figsize=(1.5 + 3.6 * columns, 1.2 + 3.2 * rows), squeeze=False)
    for axes in panels.flat[len(scenes) :]:
        axes.set_visible(False)
    return figure, list(zip(panels.flat, scenes))


def _stage_legend(figure, stages: list[str]) -> None:
    handles = [plt.Rectangle((0, 0), 1, 1, color=color) for color in _stage_colors(stages)]
    figure.legend(handles, stages, loc="outside lower center", ncols=min(len(stages), 5), fontsize=8)


def _stage_colors(stages: list[str]) -> list[str]:
    return [COLORS[index % len(COLORS)] for index in range(len(stages))]


def _subtitle(scene: dict, lengths: bool = True) -> str:
    paths = f", {scene['photon_path_length']}+{scene['camera_path_length']}" if lengths else ""
    width, height = scene["size"]
    return f"{label_of(scene)}\n{width} x {height}, {scene['photons']} photons{paths}"


def _iterations(document: dict):
    figure, panels = _panels(document["scenes"])
    stages = list(document["scenes"][0]["blocks"][0]["seconds"])
    for axes, scene in panels:
        blocks = scene["blocks"]
        # Steps: a block's mean stands from its first iteration to its last.
        edges = np.array([(block["first"] - 0.5, block["last"] + 0.5) for block in blocks]).ravel()
        heights = [np.repeat([1e3 * block["seconds"][stage] for block in blocks], 2) for stage in stages]
        axes.stackplot(edges, heights, colors=_stage_colors(stages), lw=0)
        axes.set(xlabel="iteration", ylabel="ms of an iteration", xlim=(edges[0], edges[-1]))
        axes.set_title(_subtitle(scene), fontsize=9)
    _stage_legend(figure, stages)
    return figure


def _path_lengths(document: dict):
    figure, panels = _panels(document["scenes"])
    stages = list(document["scenes"][0]["points"][0]["seconds"])
    for axes, scene in panels:
        places = range(len(scene["points"]))
        bottom = np.zeros(len(scene["points"]))
        for stage, color in zip(stages, _stage_colors(stages)):
            heights = np.array([1e3 * point["seconds"][stage] for point in scene["points"]])
            axes.bar(places, heights, bottom=bottom, color=color)
            bottom += heights
        axes.set_xticks(places, [f"{point['length']}+{point['length']}" for point in scene["points"]])
        axes.set(xlabel="photon + camera path lengths", ylabel="ms of an iteration")
        axes.set_title(_subtitle(scene, lengths=False), fontsize=9)
        axes.grid(axis="x", visible=False)
    _stage_legend(figure, stages)
    return figure


def _sweep(document: dict, key: str, what: str, unit: str):
    """Iteration times by photons or pixels, with the straight lines, and the same divided by what is on the x axis."""
    figure, (time, each) = plt.subplots(1, 2, figsize=(12, 5.4))
    for scene, color in zip(document["scenes"], COLORS):
        x = np.array([point[key] for point in scene["points"]], float)
        y = np.array([sum(point["seconds"].values()) for point in scene["points"]])
        along = np.geomspace(x[0], x[-1], 100)
        slope = scene["line"]["slope_seconds"]
        line = scene["line"]["base_seconds"] + slope * along
        label = f"{label_of(scene)}: {plain(float(f'{1e9 * slope:.3g}'))} ns"
        time.plot(x, 1e3 * y, ls="", marker="o", markersize=5, color=color, label=label)
        time.plot(along, 1e3 * line, color=color, lw=1)
        each.plot(x, 1e9 * y / x, marker="o", markersize=5, lw=1, color=color)
    time.set(title="Time of an iteration; lines: base + slope x", xlabel=what, ylabel="ms")
    each.set(title=f"Time of an iteration for each {unit}", xlabel=what, ylabel="ns")
    for axes in (time, each):
        logarithmic(axes.xaxis)
        logarithmic(axes.yaxis)
    handles, labels = time.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, fontsize=8, title="slope", title_fontsize=8)
    return figure


def _photon_batches(document: dict):
    return _sweep(document, "photons", "photons of an iteration", "photon")


def _resolutions(document: dict):
    return _sweep(document, "pixels", "pixels of the frame", "pixel")


def _splat_radius(document: dict):
    figure, panels = plt.subplots(1, 2, figsize=(12, 5.4))
    for scene, color in zip(document["scenes"], COLORS):
        factors = [point["factor"] for point in scene["points"]]
        for axes, stage in zip(panels, ("direct splatting", "indirect splatting")):
            heights = [1e3 * point["seconds"][stage] for point in scene["points"]]
            axes.plot(factors, heights, marker="o", markersize=5, lw=1, color=color, label=label_of(scene))
            axes.set(title=stage.capitalize(), xlabel="splat radius / automatic r_max", ylabel="ms of an iteration")
    for axes in panels:
        logarithmic(axes.xaxis, 2)
        logarithmic(axes.yaxis)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, fontsize=8)
    return figure


def _roulette(document: dict):
    scenes = document["scenes"]
    figure, (time, variance) = plt.subplots(1, 2, figsize=(12, 2.4 + 0.6 * len(scenes)), sharey=True)
    rows = np.arange(len(scenes), dtype=float)
    for place, (stage, color) in enumerate((("direct splatting", COLORS[0]), ("indirect splatting", COLORS[1]))):
        for offset, key, opacity in ((0.1, "seconds_without", 1.0), (-0.1, "seconds_with", 0.5)):
            widths = [1e3 * scene[key][stage] for scene in scenes]
            label = f"{stage}, {key.removeprefix('seconds_')} roulette"
            time.barh(rows + 0.2 - 0.4 * place + offset, widths, 0.19, color=color, alpha=opacity, label=label)
    for offset, key, label in ((0.1, "with", "after as many iterations"), (-0.1, "equal time", "after as much time")):
        ratios, errors = np.array([scene["variance_ratio"][key] for scene in scenes]).T
        color = COLORS[2 if key == "with" else 3]
        variance.errorbar(ratios, rows + offset, xerr=errors, ls="", marker="o", color=color, label=label)
    time.set_yticks(rows, [label_of(scene) for scene in scenes], fontsize=8)
    time.set(title="Splatting", xlabel="ms of an iteration")
    variance.set(title="Variance with roulette / without (less is better)", xlabel="ratio, ± standard error")
    variance.axvline(1.0, color="#333333", lw=1)
    for axes in (time, variance):
        axes.grid(axis="y", visible=False)
    handles, labels = (a + b for a, b in zip(time.get_legend_handles_labels(), variance.get_legend_handles_labels()))
    figure.legend(handles, labels, loc="outside lower center", ncols=3, fontsize=8)
    return figure


def _final_gather(document: dict):
    figure, panels = _panels(document["scenes"])
    for axes, scene in panels:
        for name, style in (("plain", "--"), ("gather", "-")):
            curve = scene["curves"][name]
            for place, side in enumerate(scene["blocks"]):
                what = "pixels" if side == 1 else f"{side} x {side}"
                axes.plot(
                    [point["seconds"] for point in curve], [point["errors"][place] for point in curve], style,
                    marker="o", markersize=3, lw=1, color=COLORS[place], label=f"{what}, {name}",
                )  # fmt: skip
        axes.set(xlabel="seconds", ylabel="median relative error")
        axes.set_title(_subtitle(scene), fontsize=9)
        logarithmic(axes.xaxis)
        logarithmic(axes.yaxis)
    handles, labels = panels[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=6, fontsize=8)
    return figure


DRAWERS = {
    "iterations": _iterations,
    "path_lengths": _path_lengths,
    "photon_batches": _photon_batches,
    "resolutions": _resolutions,
    "splat_radius": _splat_radius,
    "roulette": _roulette,
    "final_gather": _final_gather,
}
