# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures the deep cubemap and the estimator: figures as JSON and PNG, and the tables of docs/benchmarks/README.md.

Needs moderngl, NumPy and numba. With the bpy module, Blender scenes are exported to out/benchmark_scenes
first; without it, those that lie there are used. Without Matplotlib only the JSON is written, and
--plot draws it elsewhere.
"""

import argparse
import json
import logging
import sys
import time
from pathlib import Path

from rppm_addon.gl.context.context import Context
from rppm_addon.gl.programs.programs import ProgramLibrary
from rppm_addon.scene.errors import RppmError

from .. import ROOT
from ..machine import Clock, describe, slug
from .catalog import FIGURES, MEASUREMENTS, is_possible, scenes_of
from .figures import ROUTES, make_cubemap
from .results.tables import write_tables
from .scenes import NAMES, SceneStore, Subject, subjects

log = logging.getLogger("benchmark")

QUICK_RAYS, SOFTWARE_RAYS, HARDWARE_RAYS = 1 << 15, 1 << 18, 1 << 20


def parse(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--figures", nargs="+", choices=FIGURES, default=list(FIGURES), metavar="FIGURE",
                        help=f"of {', '.join(FIGURES)}; all by default")  # fmt: skip
    parser.add_argument("--scenes", nargs="+", choices=NAMES, metavar="SCENE",
                        help="these for every figure, in place of each figure's own: " + ", ".join(NAMES))  # fmt: skip
    parser.add_argument("--quick", action="store_true", help="few scenes, rays and repetitions")
    parser.add_argument("--rays", type=int, metavar="N", help="rays of each kind")
    parser.add_argument("--output", type=Path, metavar="FOLDER",
                        help="docs/benchmarks by default; out/benchmarks with --quick or --scenes")  # fmt: skip
    parser.add_argument("--scene-folder", type=Path, default=ROOT.parent / "shared/scenes", metavar="FOLDER",
                        help="where the .blend files lie")  # fmt: skip
    parser.add_argument("--saved-scenes", type=Path, default=ROOT / "out/benchmark_scenes", metavar="FOLDER",
                        help="where exported scenes are kept (out/benchmark_scenes)")  # fmt: skip
    parser.add_argument("--export-only", action="store_true", help="export the Blender scenes and measure nothing")
    parser.add_argument("--commit", help="the commit to name where git is not there")
    parser.add_argument("--plot", nargs="*", type=Path, metavar="FILE.json",
                        help="measure nothing: draw stored figures, by default all below the output folder, "
                        "and write the tables there")  # fmt: skip
    options = parser.parse_args(arguments)
    if options.rays is not None and options.rays < 256:
        parser.error("--rays: 256 or more are needed for a measurement")
    if options.output is None:
        options.output = ROOT / ("out/benchmarks" if options.quick or options.scenes else "docs/benchmarks")
    return options


def wanted_scenes(options: argparse.Namespace, is_software: bool) -> dict[str, list[str]]:
    """Figures that can be measured, by scene in their order."""
    figures = [figure for figure in dict.fromkeys(options.figures) if is_possible(figure)]
    by_scene: dict[str, list[str]] = {}
    for name in NAMES:
        found = [
            figure for figure in figures if name in (options.scenes or scenes_of(figure, options.quick, is_software))
        ]
        if found:
            by_scene[name] = found
    return by_scene


def warm_up(subject: Subject, clock: Clock) -> None:
    """Make all programs, which takes longer than the smallest builds."""
    for rasterize in ROUTES.values():
        cubemap = make_cubemap(subject, rasterize)
        subject.build(cubemap)
        subject.trace_times(clock, subject.traced_by(cubemap))
        cubemap.release()


def measure(options: argparse.Namespace) -> list[Path]:
    """Measure all that is asked for; returns the JSON files."""
    store = SceneStore(options.scene_folder, options.saved_scenes)
    context = Context.create()
    library = ProgramLibrary(context)
    try:
        clock = Clock(context, options.quick)
        by_scene = wanted_scenes(options, clock.is_software)
        machine = describe(context, clock, options.commit)
        count = options.rays or (QUICK_RAYS if options.quick else SOFTWARE_RAYS if clock.is_software else HARDWARE_RAYS)
        for subject in subjects(["room_1k"], store, context, library, 1024):
            warm_up(subject, clock)
        figures: dict[str, list[dict]] = {}
        for subject in subjects(list(by_scene), store, context, library, count):
            for figure in by_scene[subject.name]:
                start = time.monotonic()
                try:
                    result = MEASUREMENTS[figure](subject, clock, options.quick)
                except RppmError as error:
                    log.warning("%s is left out of %s: %s", subject.name, figure, error)
                    continue
                line = {"scene": subject.name, "source": subject.source, "triangles": subject.triangle_count, **result}
                figures.setdefault(figure, []).append(line)
                log.info("%-20s %-13s %5.1f s", subject.name, figure, time.monotonic() - start)
    finally:
        library.release()
        context.release()
    if not figures:
        return []
    folder = options.output / slug(machine)
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for figure, lines in figures.items():
        lines.sort(key=lambda line: line["triangles"])
        document = {"figure": figure, "machine": machine, "quick": options.quick, "rays_of_a_kind": count}
        written.append(folder / f"{figure}.json")
        text = json.dumps(_rounded({**document, "scenes": lines}), indent=1)
        temporary = written[-1].with_suffix(".json.new")
        temporary.write_text(text + "\n", encoding="utf-8")
        temporary.replace(written[-1])
    return written


def _rounded(value: object) -> object:
    """Floats to five digits: more are noise."""
    if isinstance(value, float):
        return float(f"{value:.5g}")
    if isinstance(value, dict):
        return {key: _rounded(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_rounded(item) for item in value]
    return value


def draw(files: list[Path]) -> None:
    """Draw figures beside their JSON, where Matplotlib is."""
    try:
        from .results.plots import draw_figure
    except ModuleNotFoundError as error:
        if error.name != "matplotlib":
            raise
        log.warning("no plots are drawn without Matplotlib: pip install -e .[bench], then run with --plot")
        return
    for file in files:
        draw_figure(file)


def main(arguments: list[str] | None = None) -> int:
    options = parse(arguments)
    logging.basicConfig(level=logging.WARNING, format="benchmark: %(message)s")
    log.setLevel(logging.INFO)
    if options.export_only:
        store = SceneStore(options.scene_folder, options.saved_scenes)
        missing = [name for name in wanted_scenes(options, is_software=False) if store.load(name) is None]
        return 1 if missing else 0
    if options.plot is not None:
        files = options.plot or sorted(options.output.glob("*/*.json"))
    else:
        files = measure(options)
    if not files:
        log.warning("there is nothing to draw")
        return 1
    draw(files)
    write_tables(options.output)
    return 0


if __name__ == "__main__":
    sys.exit(main())
