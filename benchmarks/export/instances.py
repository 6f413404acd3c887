# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures what many instances cost on their way from Blender to the renderer's process.

Prints a table of milliseconds of processor time, the least of some runs. Needs the bpy module.
"""

import argparse
import sys
import time
from collections.abc import Callable

import bpy

import rppm_addon
from rppm_addon.blender.export import export_scene
from rppm_addon.scene import Scene

from .scenes import SCENES
from .speed import Stopwatch, Transfer

COUNTS = {
    "geometry_nodes": (5_000, 50_000, 500_000),
    "particles": (5_000, 50_000, 500_000),
    "collections": (5_000, 20_000),
    "objects": (5_000, 20_000),
}
"""Numbers of instances by scene: a scene of more objects takes Blender minutes to make."""
STEPS = ("Blender", "export", "send", "receive", "expand")
_RUNS = 3


def pass_of_blender(depsgraph: bpy.types.Depsgraph) -> None:
    """Have Blender go through all instances, of which nothing is asked."""
    for _ in depsgraph.object_instances:
        pass


def measure(name: str, count: int) -> dict[str, float]:
    """Milliseconds of processor time by step, the least of some runs."""
    SCENES[name][0](count)
    scene = bpy.context.scene
    scene.frame_set(3)
    depsgraph, least = bpy.context.evaluated_depsgraph_get(), dict.fromkeys(STEPS, float("inf"))

    def timed(step: str, work: Callable[[], Scene | None]) -> Scene | None:
        began = time.process_time()
        result = work()
        least[step] = min(least[step], 1e3 * (time.process_time() - began))
        return result

    for _ in range(_RUNS):
        timed("Blender", lambda: pass_of_blender(depsgraph))
        exported = timed("export", lambda: export_scene(depsgraph))
        watch = Stopwatch()
        received = Transfer(watch).send(exported)
        for step in ("send", "receive"):
            least[step] = min(least[step], 1e3 * watch.seconds[step][0][1])
        timed("expand", received.expanded)
    return least


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scenes", nargs="+", choices=COUNTS, default=list(COUNTS), metavar="SCENE",
                        help=f"of {', '.join(COUNTS)}; all by default")  # fmt: skip
    parser.add_argument("--most", type=int, default=500_000, metavar="N", help="no more instances (500000)")
    options = parser.parse_args(arguments)
    rppm_addon.register()
    try:
        print("| scene | instances | " + " | ".join(STEPS) + " |\n|---" + "|--:" * (len(STEPS) + 1) + "|")
        for name in options.scenes:
            for count in COUNTS[name]:
                if count <= options.most:
                    figures = measure(name, count)
                    cells = " | ".join(f"{figures[step]:.1f}" for step in STEPS)
                    print(f"| {name} | {count:,} | {cells} |", flush=True)
    finally:
        rppm_addon.unregister()
    return 0


if __name__ == "__main__":
    sys.exit(main())
