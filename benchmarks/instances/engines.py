# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures of one engine and one file, each in a process of its own: `python -m benchmarks.instances.engines`."""

import dataclasses
import json
import resource
import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path

import bpy

import rppm_addon
from rppm_addon.blender.export import export_scene
from rppm_addon.gl.context.context import Context
from rppm_addon.gl.programs.programs import ProgramLibrary
from rppm_addon.integrator.progressive import ProgressivePhotonMapper
from rppm_addon.scene import Scene
from rppm_addon.scene.storage.sharing import share

from .scenes import has_moved, move, settle

_SAMPLES = 3
_GB = 1e9


def _memory(is_peak: bool = True) -> float:
    """Gigabytes of this process, now or at its peak."""
    if is_peak:
        return 1024.0 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / _GB
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * resource.getpagesize() / _GB


def _seconds(work: Callable[[], object]) -> float:
    """Processor seconds of all threads."""
    began = time.process_time()
    work()
    return time.process_time() - began


def rppm(figures: dict[str, float]) -> None:
    """Export, build, sample and edit as the renderer does, in Blender's process."""
    scenes: list[Scene] = []

    def export() -> None:
        exported = export_scene(bpy.context.evaluated_depsgraph_get())
        exported.settings = dataclasses.replace(exported.settings, iterations=1024, passes=())
        scenes.append(share(scenes[-1] if scenes else None, exported, compare_large=True))

    figures["export"] = _seconds(export)
    figures["memory exported"] = _memory()
    context = Context.create()
    library = ProgramLibrary(context)

    def take(mapper: ProgressivePhotonMapper, before: Scene | None = None) -> None:
        mapper.update(scenes[-1].expanded(before))
        context.finish()

    def sample(mapper: ProgressivePhotonMapper) -> None:
        mapper.iterate()
        context.finish()

    mapper = ProgressivePhotonMapper(context, library)
    take(mapper)  # compiles the programs
    sample(mapper)
    figures["sample"] = statistics.median(_seconds(lambda: sample(mapper)) for _ in range(_SAMPLES))
    figures["peak"] = _memory()
    for kind in ("first edit", "edit") if has_moved() else ():
        move()
        bpy.context.view_layer.update()
        figures[f"{kind} exported"] = _seconds(export)
        figures[kind] = _seconds(lambda: take(mapper, scenes[-2]))
    figures["device"] = sum(mapper.memory_bytes.values()) / _GB
    if has_moved():
        figures["peak edited"] = _memory()
    mapper.release()
    again = ProgressivePhotonMapper(context, library)
    figures["first build"] = _seconds(lambda: take(again))


def cycles(figures: dict[str, float]) -> None:
    """Render stills of one sample and of some more, and once more when one instance has moved."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.use_persistent_data = True
    scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
    scene.cycles.device = "CPU"

    def render(samples: int) -> float:
        scene.cycles.samples = samples
        return _seconds(bpy.ops.render.render)

    whole = render(1)
    figures["peak"] = _memory()
    more, one = render(1 + 4 * _SAMPLES), render(1)
    figures["sample"] = max(more - one, 0.0) / (4 * _SAMPLES)
    figures["first build"] = whole - figures["sample"]
    if has_moved():
        move()
        figures["edit"] = render(1) - figures["sample"]
        figures["peak edited"] = _memory()


_ENGINES: dict[str, Callable[[dict[str, float]], None]] = {"rppm": rppm, "cycles": cycles}


def main(engine: str, path: str) -> None:
    """Print figures of an engine and a .blend file as JSON: processor seconds, and gigabytes of this process."""
    rppm_addon.register()
    bpy.ops.wm.open_mainfile(filepath=path, load_ui=False, use_scripts=False)
    settle()
    bpy.context.evaluated_depsgraph_get().update()
    figures = {"Blender": _memory(is_peak=False)}
    _ENGINES[engine](figures)
    print(json.dumps(figures), flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
