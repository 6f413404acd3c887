# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures what a frame costs in which all geometry or all instances move: export, transfer and upload.

Prints a table and, with --output, writes the figures as JSON. Needs the bpy module.
"""

import argparse
import json
import logging
import statistics
import sys
import time
from collections import defaultdict
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from unittest import mock

import bpy
import numpy as np

import rppm_addon
from rppm_addon.blender.export import SceneSync, export_scene
from rppm_addon.gl.context.context import Context
from rppm_addon.gl.programs.programs import ProgramLibrary
from rppm_addon.integrator.progressive import ProgressivePhotonMapper
from rppm_addon.scene import Camera, Scene
from rppm_addon.session.transport.arrays import pack, unpack
from rppm_addon.session.transport.protocol import frame_message
from rppm_addon.session.transport.transfer import SceneReceiver, SceneSender

from ..machine import Clock, describe
from .scenes import SCENES

STAGES = ("Blender", "export", "send", "receive", "upload", "gather", "others", "fresh export")
CAMERA = Camera(np.diag((1.0, 1.0, 1.0, 1.0)), (-1.0, 1.0, -1.0, 1.0), 32, 32)
WARM_UP = 3
"""Frames before the first that counts: programs are made, buffers grow."""


class Stopwatch:
    """Wall time and this process's time by stage."""

    def __init__(self) -> None:
        self.seconds: dict[str, list[tuple[float, float]]] = defaultdict(list)

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        wall, busy = time.perf_counter(), time.process_time()
        yield
        self.seconds[name].append((time.perf_counter() - wall, time.process_time() - busy))

    def forget(self) -> None:
        self.seconds.clear()

    def figures(self) -> dict[str, dict[str, float]]:
        """By stage, medians and the least wall time, ms."""
        return {
            name: {
                "wall_ms": 1e3 * statistics.median(wall for wall, _ in times),
                "least_wall_ms": 1e3 * min(wall for wall, _ in times),
                "processor_ms": 1e3 * statistics.median(busy for _, busy in times),
            }
            for name, times in self.seconds.items()
        }


class Device:
    """Takes scenes as the renderer does; the acceleration structure is built of the first only."""

    def __init__(self) -> None:
        self.context = Context.create()
        self._library = ProgramLibrary(self.context)
        self._mapper = ProgressivePhotonMapper(self.context, self._library)

    def take(self, scene: Scene, watch: Stopwatch) -> None:
        """Counts as upload what Geometry and the attributes of surfaces take, but for the gathering of triangles."""
        geometry, resolve = self._mapper.device_scene.geometry, self._mapper.device_scene.resolve
        spent = {owner: np.zeros(2) for owner in (geometry, resolve, geometry._gather)}

        def timed(owner: object, work: Callable) -> Callable:
            def run(*arguments: object, **named: object) -> None:
                self.context.finish()
                started = np.array([time.perf_counter(), time.process_time()])
                work(*arguments, **named)
                self.context.finish()
                spent[owner] += np.array([time.perf_counter(), time.process_time()]) - started

            return run

        started = np.array([time.perf_counter(), time.process_time()])
        with (
            mock.patch.object(geometry, "build", timed(geometry, geometry.build)),
            mock.patch.object(resolve, "build", timed(resolve, resolve.build)),
            mock.patch.object(geometry._gather, "run", timed(geometry._gather, geometry._gather.run)),
        ):
            self._mapper.update(scene.expanded())
            self.context.finish()
        whole = np.array([time.perf_counter(), time.process_time()]) - started
        self._mapper.device_scene._build_acceleration = lambda *_: None
        gather = spent[geometry._gather]
        upload = spent[geometry] + spent[resolve] - gather
        for name, seconds in (("gather", gather), ("upload", upload), ("others", whole - upload - gather)):
            watch.seconds[name].append(tuple(seconds.tolist()))

    def release(self) -> None:
        self._mapper.release()
        self._library.release()
        self.context.release()


def finish_evaluation(depsgraph: bpy.types.Depsgraph) -> None:
    """Have Blender make what it makes when asked first: triangles and normals."""
    for source in depsgraph.objects:
        if source.type == "MESH" and len(source.data.polygons) > 1000:
            source.data.calc_loop_triangles()
            if len(source.data.corner_normals):
                source.data.corner_normals[0].vector.copy()


class Transfer:
    """Transfer of scenes from Blender's process to the renderer's, both ends in this one."""

    def __init__(self, watch: Stopwatch) -> None:
        self._watch = watch
        self._sender, self._receiver = SceneSender(), SceneReceiver()

    def send(self, scene: Scene) -> Scene:
        messages, blocks = [], []
        with self._watch.stage("send"):
            parts, whole = self._sender.send(1, scene)
            for part in (*parts, whole):
                description, block = pack(part.arrays)
                blocks.append(block)
                messages.append(frame_message("members", document=part.document, arrays=description))
        with self._watch.stage("receive"):
            *members, last = (json.loads(message[4:]) for message in messages)
            for message in members:
                self._receiver.learn(message["document"], unpack(message["arrays"]))
            received = self._receiver.receive(last["document"], unpack(last["arrays"]))
        for block in blocks:
            if block is not None:
                block.close()
        return received


def measure(make: Callable[[int], None], size: int, frames: int, device: Device) -> dict:
    """Figures of a scene over some frames."""
    watch = Stopwatch()
    make(size)
    sync, transfer = SceneSync(), Transfer(watch)
    scene = bpy.context.scene

    def follow(_: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
        finish_evaluation(depsgraph)
        evaluated = time.perf_counter(), time.process_time()
        watch.seconds["Blender"].append((evaluated[0] - started[0], evaluated[1] - started[1]))
        with watch.stage("export"):
            exported = sync.update(depsgraph, CAMERA)
        device.take(transfer.send(exported), watch)
        with watch.stage("fresh export"):
            export_scene(depsgraph)

    bpy.app.handlers.frame_change_post.append(follow)
    try:
        for number in range(WARM_UP + frames):
            if number == WARM_UP:
                watch.forget()
            started = time.perf_counter(), time.process_time()
            scene.frame_set(scene.frame_current + 1)
    finally:
        bpy.app.handlers.frame_change_post.remove(follow)
    last = sync.scene
    return {
        "triangles": last.triangle_count,
        "instances": last.instance_count,
        "frames": frames,
        "stages": watch.figures(),
    }


def table(scenes: dict[str, dict]) -> str:
    """In Markdown, median wall time and process time of each stage."""
    lines = ["| | triangles | instances | " + " | ".join(STAGES) + " |", "|---" + "|---:" * (len(STAGES) + 2) + "|"]
    for name, figures in scenes.items():
        cells = [
            f"{stage['wall_ms']:.1f} ({stage['processor_ms']:.1f})"
            for stage in (figures["stages"][key] for key in STAGES)
        ]
        lines.append(f"| {name} | {figures['triangles']:,} | {figures['instances']:,} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scenes", nargs="+", choices=SCENES, default=list(SCENES), metavar="SCENE",
                        help=f"of {', '.join(SCENES)}; all by default")  # fmt: skip
    parser.add_argument("--frames", type=int, default=25, metavar="N", help="frames that count (25)")
    parser.add_argument("--quick", action="store_true", help="a hundredth of the size, 3 frames")
    parser.add_argument("--output", type=Path, metavar="FILE.json", help="where the figures go")
    options = parser.parse_args(arguments)
    logging.basicConfig(level=logging.WARNING, format="benchmark: %(message)s")
    rppm_addon.register()
    device = Device()
    try:
        scenes = {}
        for name in options.scenes:
            make, size = SCENES[name]
            size, frames = (size // 100, 3) if options.quick else (size, options.frames)
            scenes[name] = measure(make, size, frames, device)
        if options.output is not None:
            machine = describe(device.context, Clock(device.context))
            options.output.parent.mkdir(parents=True, exist_ok=True)
            options.output.write_text(json.dumps({"machine": machine, "scenes": scenes}, indent=1) + "\n", "utf-8")
        print(table(scenes))
    finally:
        device.release()
        rppm_addon.unregister()
    return 0


if __name__ == "__main__":
    sys.exit(main())
