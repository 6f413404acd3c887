# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures scenes of many instances beside Cycles, and frames in which one object has moved.

    python -m benchmarks.instances                                    # a forest and a city, made by scripts
    python -m benchmarks.instances --scenes city --divisor 10         # smaller
    python -m benchmarks.instances --scenes --files grass.blend       # files by others, without an edit
    python -m benchmarks.instances --scenes --moves bmw27.blend       # frames of files with one moving object

Prints tables of processor seconds of all threads, and of gigabytes of memory: of one process that has Blender, the
exporter and the renderer, and of one that has Blender and Cycles. `Blender` is that process with the file open and
evaluated. Needs the bpy module.
"""

import argparse
import json
import math
import subprocess
import sys
from pathlib import Path

from .. import ROOT
from .moves import FRAMES, HEADER, row
from .scenes import SCENES, saved

_COLUMNS = ("Blender", "peak", "peak edited", "first build", "sample", "edit")


def measure(engine: str, path: Path) -> dict[str, float]:
    """Figures of an engine and a .blend file, in a process of its own."""
    command = [sys.executable, "-m", "benchmarks.instances.engines", engine, str(path)]
    done = subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True)
    return json.loads(done.stdout.splitlines()[-1])


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scenes", nargs="*", choices=SCENES, default=list(SCENES))
    parser.add_argument("--engines", nargs="+", choices=("rppm", "cycles"), default=["rppm", "cycles"])
    parser.add_argument("--divisor", type=int, default=1, metavar="N", help="of the scenes' sizes (1)")
    parser.add_argument("--folder", type=Path, default=ROOT / "out/benchmark_scenes/instances",
                        help="where the scenes are kept (out/benchmark_scenes/instances)")  # fmt: skip
    parser.add_argument("--files", nargs="*", type=Path, default=[], metavar="FILE", help=".blend files beside these")
    parser.add_argument(
        "--moves", nargs="*", type=Path, default=[], metavar="FILE", help=".blend files or saved scenes"
    )
    parser.add_argument("--frames", type=int, default=FRAMES, help=f"of each of these ({FRAMES})")
    options = parser.parse_args(arguments)
    scenes = [saved(name, options.divisor, options.folder) for name in options.scenes]
    for path in [*scenes, *options.files]:
        print(f"| {path.stem} | " + " | ".join(_COLUMNS) + " |\n|---" + "|--:" * len(_COLUMNS) + "|", flush=True)
        for engine in options.engines:
            figures = measure(engine, path)
            cells = " | ".join(f"{figures.get(column, math.nan):.2f}" for column in _COLUMNS)
            print(f"| {engine} | {cells} |", flush=True)
            others = ", ".join(f"{key} {value:.2f}" for key, value in figures.items() if key not in _COLUMNS)
            if others:
                print(f"{engine}: {others}", file=sys.stderr, flush=True)
    if options.moves:
        print(HEADER, flush=True)
    for path in options.moves:
        print(row(path, options.frames), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
