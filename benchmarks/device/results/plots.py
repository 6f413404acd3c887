# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws a figure's JSON as a PNG beside it."""

import json
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from . import estimator_plots
from .drawing import COLORS, STYLE, label_of, logarithmic

_KIND_COLORS = {"camera": "#1f6fb4", "diffuse bounce": "#e07b00", "photon": "#2f9e44"}
_PLACE_COLORS = {
    "inside": "#9aa5b1", "outside": "#c92a2a", "emitter": "#f0a500", "camera": "#1f6fb4", "middle": "#2f9e44",
}  # fmt: skip
_PLACE_LABELS = {
    "inside": "random, inside the bounds",
    "outside": "random, outside",
    "emitter": "on an emitter",
    "camera": "the camera",
    "middle": "middle of the bounds",
}


def draw_figure(file: Path) -> Path:
    """Draw a JSON of run.py; returns the PNG."""
    document = json.loads(file.read_text(encoding="utf-8"))
    with plt.rc_context(STYLE):
        figure = _DRAWERS[document["figure"]](document)
        machine = document["machine"]
        quick = ", quick run" if document["quick"] else ""
        device = str(machine["device"])
        if machine["software_driver"]:
            device += f" on {machine['processor']}, {machine['cores']} cores"
        figure.suptitle(
            f"{device}\ncommit {machine['commit']}, {machine['date']}{quick}; {machine['clock']}",
            fontsize=8, color="#555555",
        )  # fmt: skip
        picture = file.with_suffix(".png")
        figure.savefig(picture, metadata={"Software": None})
        plt.close(figure)
    return picture


def _construction(document: dict):
    figure, ((time, factor), (fragments, memory)) = plt.subplots(2, 2, figsize=(12, 9.5))
    scenes = document["scenes"]

    def curve(axes, value, label: str, color: str, marker: str, dashed: bool = False) -> None:
        """The made scenes as a line, the others as single marks."""
        points = [(scene["triangles"], value(scene), scene["source"]) for scene in scenes]
        made = [(x, y) for x, y, source in points if source == "made" and y is not None]
        others = [(x, y) for x, y, source in points if source != "made" and y is not None]
        if made:
            axes.plot(*zip(*made), color=color, marker=marker, markersize=4, label=label, ls="--" if dashed else "-")
        if others:
            axes.plot(
                *zip(*others), color=color, marker=marker, markersize=6, ls="", mfc="none",
                label=None if made else label,
            )  # fmt: skip

    def route(name: str, key: str, size: float = 1.0):
        return lambda scene: scene["routes"][name][key] * size if key in scene["routes"][name] else None

    def hierarchy(key: str, name: str, size: float = 1.0):
        def value(scene: dict) -> float | None:
            found = scene["hierarchies"].get(name)
            if found is None or (key == "factor" and name not in scene["times_the_rebuild"]):
                return None
            return scene["times_the_rebuild"][name] if key == "factor" else found["seconds"] * size

        return value

    threads = {name: values["threads"] for scene in scenes for name, values in scene["hierarchies"].items()}
    curve(time, route("rasterization", "rebuild_seconds", 1e3), "cubemap, rasterization", COLORS[0], "o")
    curve(time, route("rasterization", "first_seconds", 1e3), "the same, first build", COLORS[0], "v", True)
    curve(time, route("compute", "rebuild_seconds", 1e3), "cubemap, compute", COLORS[2], "s")
    curve(time, route("compute", "first_seconds", 1e3), "the same, first build", COLORS[2], "^", True)
    for name, color in (("SAH", COLORS[3]), ("Embree", COLORS[1])):
        if name in threads:
            label = f"boxes, {name}, {threads[name]} thread" + "s" * (threads[name] > 1)
            curve(time, hierarchy("seconds", name, 1e3), label, color, "D")
            curve(factor, hierarchy("factor", name), label, color, "D")
    for key, label, color, marker in (
        ("fragments_per_triangle", "in cells (fragments)", COLORS[0], "o"),
        ("entries_per_triangle", "in depth bins (entries)", COLORS[4], "s"),
    ):
        if any(key in scene["routes"]["rasterization"] for scene in scenes):
            curve(fragments, route("rasterization", key), label, color, marker)
    factor.axhline(1.0, color="#333333", lw=1)
    for axes, title, unit in (
        (time, "Build time", "ms"),
        (factor, "Building boxes / rebuilding the cubemap by rasterization", "factor"),
        (fragments, "How often a triangle is stored", "times per triangle"),
    ):
        axes.set(title=title, xlabel="triangles (lines: made rooms; open marks: other scenes)", ylabel=unit)
        logarithmic(axes.xaxis)
        logarithmic(axes.yaxis)
    time.legend(fontsize=8)
    factor.legend(fontsize=8)
    fragments.legend(fontsize=8)

    shown = [scene for scene in scenes if "memory_bytes" in scene["routes"]["rasterization"]]
    sizes: dict[str, np.ndarray] = {}
    for row, scene in enumerate(shown):
        for name, size in scene["routes"]["rasterization"]["memory_bytes"].items():
            sizes.setdefault(name.removeprefix("deep cubemap "), np.zeros(len(shown)))[row] = size / 2**20
    names = sorted(sizes, key=lambda name: -sizes[name].max())
    if len(names) > len(COLORS):
        few = names[: len(COLORS) - 1]
        sizes["others"] = sum(sizes[name] for name in names[len(few) :])
        names = [*few, "others"]
    left = np.zeros(len(shown))
    for name, color in zip(names, COLORS):
        memory.barh(range(len(shown)), sizes[name], left=left, color=color, label=name)
        left += sizes[name]
    memory.set_yticks(range(len(shown)), [label_of(scene) for scene in shown], fontsize=8)
    memory.set(title="Memory held, by buffer", xlabel="MiB")
    memory.grid(axis="y", visible=False)
    memory.legend(fontsize=8)
    return figure


def _sweep(document: dict, key: str, what: str):
    """Memory, build time and time per ray against a knob; dotted is the cubemap's own choice (None or 0)."""
    figure, panels = plt.subplots(1, 3, figsize=(13, 5.2))
    for scene, color in zip(document["scenes"], COLORS * 2):
        good = [point for point in scene["points"] if "failure" not in point]
        points = [point for point in good if point[key]]
        values = [_sweep_values(point, scene["rays"]) for point in points]
        own = [_sweep_values(point, scene["rays"]) for point in good if not point[key]]
        for index, axes in enumerate(panels):
            heights = [value[index] for value in values]
            axes.plot([p[key] for p in points], heights, color=color, marker="o", markersize=4, label=label_of(scene))
            for value in own:
                axes.axhline(value[index], color=color, lw=1.0, ls=":")
    ticks = sorted({point[key] for scene in document["scenes"] for point in scene["points"] if point[key]})
    for axes, title, unit in zip(
        panels, ("Memory held", "Rebuild", "Tracing, mean of the kinds of rays"), ("MiB", "ms", "ns per ray")
    ):
        axes.set(title=title, xlabel=what, ylabel=unit)
        logarithmic(axes.xaxis, 2)
        logarithmic(axes.yaxis)
        axes.set_xticks(ticks, [str(tick) for tick in ticks])
    handles, labels = panels[0].get_legend_handles_labels()
    handles.append(plt.Line2D([], [], color="#333333", lw=1.0, ls=":"))
    labels.append("automatic choice")
    figure.legend(handles, labels, loc="outside lower center", ncols=4, fontsize=8)
    return figure


def _sweep_values(point: dict, rays: dict[str, int]) -> tuple[float, float, float]:
    """MiB, milliseconds, nanoseconds per ray."""
    return sum(point["memory_bytes"].values()) / 2**20, 1e3 * point["rebuild_seconds"], _nanoseconds(point, rays)


def _nanoseconds(point: dict, rays: dict[str, int]) -> float:
    return 1e9 * float(np.mean([seconds / rays[kind] for kind, seconds in point["trace_seconds"].items()]))


def _resolution(document: dict):
    return _sweep(document, "resolution", "most cells along a face's side")


def _bins(document: dict):
    return _sweep(document, "max_bins", "most depth bins of a cell")


def _rays(document: dict):
    scenes = document["scenes"]
    figure, (speed, ratio) = plt.subplots(1, 2, figsize=(12, 2.0 + 0.42 * len(scenes)), sharey=True)
    for place, (kind, color) in enumerate(_KIND_COLORS.items()):
        shown = [(index, scene["kinds"][kind]) for index, scene in enumerate(scenes) if kind in scene["kinds"]]
        if not shown:
            continue
        rows = np.array([index for index, _ in shown]) + 0.26 * (1 - place)
        cubemap = [values["cubemap_rays_per_second"] / 1e6 for _, values in shown]
        boxes = [values["boxes_rays_per_second"] / 1e6 for _, values in shown]
        speed.hlines(rows, cubemap, boxes, color=color, lw=1.2, alpha=0.6)
        speed.plot(cubemap, rows, ls="", marker="o", markersize=5, color=color, label=f"cubemap, {kind} rays")
        speed.plot(boxes, rows, ls="", marker="|", markersize=8, mew=2, color=color, label=f"boxes, {kind} rays")
        ratios = [values["ratio"] for _, values in shown]
        mean = float(np.exp(np.mean(np.log(ratios))))
        label = f"{kind} rays, geometric mean {mean:.2f}, worst {min(ratios):.2f}"
        ratio.plot(ratios, rows, ls="", marker="o", markersize=5, color=color, label=label)
    speed.set_yticks(range(len(scenes)), [label_of(scene) for scene in scenes], fontsize=8)
    speed.set_ylim(-0.6, len(scenes) - 0.4)
    speed.set(title="Speed", xlabel="Mray/s")
    ratio.set(title="Cubemap's speed over that of the boxes (more is better)", xlabel="ratio")
    ratio.axvline(1.0, color="#333333", lw=1)
    for axes, columns in ((speed, 3), (ratio, 1)):
        logarithmic(axes.xaxis)
        axes.grid(axis="y", visible=False)
        for edge in range(1, len(scenes)):
            axes.axhline(edge - 0.5, color="#dddddd", lw=0.8)
        below = -0.5 / (0.42 * len(scenes) + 0.4)
        axes.legend(fontsize=8, loc="upper center", bbox_to_anchor=(0.5, below), ncols=columns, columnspacing=1.2)
    return figure


def _placement(document: dict):
    scenes = document["scenes"]
    kinds = [kind for kind in _KIND_COLORS if any(kind in scene["rays"] for scene in scenes)]
    figure, panels = plt.subplots(
        1, len(kinds), figsize=(13, 1.8 + 0.62 * len(scenes)), sharey=True, sharex=True, squeeze=False
    )
    jitter = np.random.default_rng(0)
    for axes, kind in zip(panels[0], kinds):
        everything = []
        for row, scene in enumerate(scenes):
            inside = []
            for place, color in _PLACE_COLORS.items():
                values = [p["relative"][kind] for p in scene["places"] if p["place"] == place and kind in p["relative"]]
                spread = jitter.uniform(-0.25, 0.25, len(values)) if len(values) > 1 else np.zeros(len(values))
                axes.plot(values, row + spread, ls="", marker="o", markersize=4.5, color=color, alpha=0.85)
                inside += values if place == "inside" else []
            if inside:
                axes.plot([np.median(inside)] * 2, [row - 0.36, row + 0.36], color="#555555", lw=1.4)
            everything += inside
        axes.axvline(1.0, color="#333333", lw=1)
        axes.set(xlabel="trace time / that of the automatic place")
        share = f", {np.mean(np.array(everything) > 1.0):.0%} of the inside ones are slower" if everything else ""
        axes.set_title(f"{kind} rays{share}", fontsize=9)
        logarithmic(axes.xaxis, 2)
        axes.grid(axis="y", visible=False)
    panels[0][0].set_yticks(range(len(scenes)), [label_of(scene) for scene in scenes], fontsize=8)
    handles = [plt.Line2D([], [], ls="", marker="o", color=color) for color in _PLACE_COLORS.values()]
    handles.append(plt.Line2D([], [], color="#555555", lw=1.4))
    figure.legend(
        handles, [*(_PLACE_LABELS[place] for place in _PLACE_COLORS), "median of those inside"],
        loc="outside lower center", ncols=6, fontsize=8,
    )  # fmt: skip
    return figure


_DRAWERS = {
    "construction": _construction,
    "resolution": _resolution,
    "bins": _bins,
    "rays": _rays,
    "placement": _placement,
    **estimator_plots.DRAWERS,
}
