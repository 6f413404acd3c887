# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures what frames of an animation cost beside their iterations, and whether anything grows from frame to frame.

Prints tables and, with --output, writes the figures as JSON. Needs the bpy module.
"""

import argparse
import json
import logging
import math
import os
import statistics
import sys
import tempfile
import time
from pathlib import Path

import bpy
from support.held import HeldByFrame

import rppm_addon
from rppm_addon.gl.context.context import Context
from rppm_addon.integrator.device_scene.acceleration import Acceleration
from rppm_addon.session.render.observers import RenderObserver, observing

from .machine import Clock, describe

STAGES = ("Blender", "export", "update", "iterations", "result", "saving")
OVERHEAD = ("update", "result")
WARM_UP = 3


def static_scene(side: int) -> bpy.types.Scene:
    """2 side^2 triangles of a wavy floor in a few objects, a light, and a camera that circles above."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    for number in range(4):
        place = number % 2 * 2, number // 2 * 2, 0.0
        bpy.ops.mesh.primitive_grid_add(x_subdivisions=side // 2, y_subdivisions=side // 2, size=2.0, location=place)
        mesh = bpy.context.object.data
        for vertex in mesh.vertices:
            vertex.co.z = 0.1 * math.sin(9.0 * vertex.co.x) * math.cos(7.0 * vertex.co.y)
    light = bpy.data.objects.new("Light", bpy.data.lights.new("Light", "POINT"))
    light.location, light.data.energy = (1.0, 1.0, 3.0), 300.0
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    for made in (light, camera):
        scene.collection.objects.link(made)
    target = camera.constraints.new("TRACK_TO")
    target.target = bpy.data.objects["Grid"]
    for frame in range(1, 201):
        angle = 2.0 * math.pi * frame / 200.0
        camera.location = (1.0 + 3.0 * math.cos(angle), 1.0 + 3.0 * math.sin(angle), 2.5)
        camera.keyframe_insert("location", frame=frame)
    scene.camera = camera
    return scene


def moving_scene() -> bpy.types.Scene:
    """Small, and with all that changes: geometry, its amount, objects that come and go, materials, lights, camera."""
    scene = static_scene(8)
    shown = bpy.data.objects["Grid"]
    wave = shown.modifiers.new("Wave", "WAVE")
    wave.height = 0.2
    array = bpy.data.objects["Grid.001"].modifiers.new("Array", "ARRAY")
    driver = array.driver_add("count").driver
    driver.expression = "1 + frame % 4"
    bpy.data.objects["Grid.002"].driver_add("hide_render").driver.expression = "frame % 3 == 0"
    material = bpy.data.materials.new("Changing")
    shown.data.materials.append(material)
    roughness = material.node_tree.nodes["Principled BSDF"].inputs["Roughness"]
    roughness.driver_add("default_value").driver.expression = "0.2 + 0.6 * (frame % 7) / 7"
    bpy.data.lights["Light"].driver_add("energy").driver.expression = "200 + frame % 11"
    return scene


def set_up(scene: bpy.types.Scene, folder: str, size: int, frames: int, persistent: bool, **settings: object) -> None:
    scene.render.engine = "RPPM"
    scene.render.resolution_x = scene.render.resolution_y = size
    scene.render.use_persistent_data = persistent
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.filepath = str(Path(folder) / "####")
    scene.frame_start, scene.frame_end = 1, frames
    for name, value in settings.items():
        setattr(scene.rppm, name, value)


class Times(RenderObserver):
    """Seconds of each frame by stage, on the wall and of this process."""

    def __init__(self) -> None:
        self.frames: list[dict[str, tuple[float, float]]] = []
        self._mark = (0.0, 0.0)

    def take(self, stage: str | None) -> None:
        now = time.perf_counter(), time.process_time()
        if stage is not None:
            before = self.frames[-1].get(stage, (0.0, 0.0))
            self.frames[-1][stage] = tuple(b + n - m for b, n, m in zip(before, now, self._mark))
        self._mark = now

    def on_scene(self, scene):
        self.take("export")
        return True

    def on_start(self, scene):
        self.take("export")

    def on_progress(self, progress):
        self.take("iterations" if progress.iteration else "update")

    def on_finish(self, result, scene):
        self.take("result")


def frame_times(size: int, side: int, frames: int, iterations: int, persistent: bool) -> dict[str, object]:
    """Medians in milliseconds of the frames of an animation in which only the camera moves."""
    scene = static_scene(side)
    times = Times()
    builds = []
    build = Acceleration.build
    from rppm_addon.blender.engine import render_engine

    render = render_engine.render_final

    def begin(*_: object) -> None:
        times.frames.append({})
        times.take(None)

    def rendered(*arguments: object) -> None:
        times.take("Blender")
        render(*arguments)

    handlers = (bpy.app.handlers.render_pre, begin), (bpy.app.handlers.render_write, lambda *_: times.take("saving"))
    with tempfile.TemporaryDirectory() as folder:
        set_up(scene, folder, size, WARM_UP + frames, persistent, iterations=iterations)
        for handler, function in handlers:
            handler.append(function)
        render_engine.render_final = rendered
        Acceleration.build = lambda *a, **k: (builds.append(True), build(*a, **k))[1]
        try:
            with observing(times):
                bpy.ops.render.render(animation=True)
        finally:
            Acceleration.build, render_engine.render_final = build, render
            for handler, function in handlers:
                handler.remove(function)
    counted = times.frames[WARM_UP:]

    def median(stages: tuple[str, ...], clock: int) -> float:
        return 1000.0 * statistics.median(sum(frame[stage][clock] for stage in stages) for frame in counted)

    return {
        "size": size,
        "triangles": 2 * (side // 2) ** 2 * 4,
        "frames": len(counted),
        "iterations": iterations,
        "persistent_data": persistent,
        "builds_of_the_structure": len(builds),
        "wall_ms": {stage: median((stage,), 0) for stage in STAGES},
        "processor_ms": {stage: median((stage,), 1) for stage in STAGES},
        "overhead_ms": {"wall": median(OVERHEAD, 0), "processor": median(OVERHEAD, 1)},
    }


def held(frames: int, persistent: bool) -> list[dict[str, int]]:
    """Return what is held after every tenth of the frames of an animation in which everything changes."""
    scene = moving_scene()
    with tempfile.TemporaryDirectory() as folder, HeldByFrame(every=max(1, frames // 10)) as watch:
        set_up(scene, folder, 16, frames, persistent, iterations=1, photons=512)
        bpy.ops.render.render(animation=True)
    return watch.frames


def times_table(lines: list[dict]) -> str:
    """In Markdown, median wall time (process time) of each stage in milliseconds."""
    names = ["picture", "persistent data", *STAGES, "overhead", "builds"]
    rows = ["| " + " | ".join(names) + " |", "|---|---" + "|---:" * (len(names) - 2) + "|"]
    for line in lines:
        cells = [f"{line['wall_ms'][stage]:.1f} ({line['processor_ms'][stage]:.1f})" for stage in STAGES]
        overhead = "{wall:.1f} ({processor:.1f})".format(**line["overhead_ms"])
        shown = [f"{line['size']}²", "on" if line["persistent_data"] else "off", *cells, overhead]
        rows.append("| " + " | ".join([*shown, str(line["builds_of_the_structure"])]) + " |")
    return "\n".join(rows)


def held_table(frames: list[dict[str, int]]) -> str:
    """In Markdown."""
    names = list(frames[0])
    rows = ["| " + " | ".join("MiB" if name == "bytes" else name for name in names) + " |", "|---:" * len(names) + "|"]
    for entry in frames:
        cells = [f"{entry[name] / 2**20:.1f}" if name == "bytes" else str(entry[name]) for name in names]
        rows.append("| " + " | ".join(cells) + " |")
    return "\n".join(rows)


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sizes", type=int, nargs="+", default=[64, 256], metavar="N", help="pixels a side (64 256)")
    parser.add_argument("--frames", type=int, default=12, metavar="N", help="frames that are timed (12)")
    parser.add_argument("--held-frames", type=int, default=500, metavar="N",
                        help="frames whose memory is watched (500)")  # fmt: skip
    parser.add_argument("--quick", action="store_true", help="a hundredth of the triangles, few frames")
    parser.add_argument("--output", type=Path, metavar="FILE.json", help="where the figures go")
    options = parser.parse_args(arguments)
    logging.basicConfig(level=logging.WARNING, format="benchmark: %(message)s")
    side, frames, held_frames = 224, options.frames, options.held_frames
    sizes = options.sizes
    if options.quick:
        side, frames, held_frames, sizes = 22, 2, 20, [16]
    rppm_addon.register()
    try:
        load = os.getloadavg()[0]
        times = [frame_times(size, side, frames, 2, persistent) for size in sizes for persistent in (False, True)]
        print(times_table(times))
        held_by = {}
        for persistent in (False, True) if held_frames else ():
            held_by["on" if persistent else "off"] = entries = held(held_frames, persistent)
            print(f"\nPersistent data {'on' if persistent else 'off'}\n\n{held_table(entries)}")
        if options.output is not None:
            context = Context.create()
            machine = describe(context, Clock(context)) | {"load": load}
            context.release()
            options.output.parent.mkdir(parents=True, exist_ok=True)
            document = {"machine": machine, "times": times, "held_by_persistent_data": held_by}
            options.output.write_text(json.dumps(document, indent=1) + "\n", "utf-8")
    finally:
        rppm_addon.unregister()
    return 0


if __name__ == "__main__":
    sys.exit(main())
