# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures how long a viewport and F12 show nothing of an exported scene, with empty and with full caches of programs.

    python -m benchmarks.first_picture docs/samples/first_light.blend ../scenes/*.blend

Prints a table: seconds of the wall clock from the exported scene to the first picture, which may be a first look under
a headlight, and to the first in true light. Each run is a process of its own with a device that is open already, as
Blender's renderer process has it by then. The second run of a scene finds in its caches what the first one left. Needs
the bpy module and a machine with nothing else to do.
"""

import argparse
import dataclasses
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import bpy

import rppm_addon
from rppm_addon.blender.export import export_scene
from rppm_addon.commands.saved_scene import camera_at_resolution
from rppm_addon.denoising.denoiser import Denoiser
from rppm_addon.gl.context.context import Context
from rppm_addon.gl.programs.programs import ProgramLibrary
from rppm_addon.scene import Scene
from rppm_addon.session.placeholders.known_programs import KnownPrograms
from rppm_addon.session.viewport.viewport_renderer import ViewportRenderer
from rppm_addon.session.worker.rendering import Rendering

from . import ROOT

_RESULT = "first pictures: "
_PICTURES = ("first", "true light")


class Found:
    """Seconds to the first two kinds of pictures that a session sends."""

    def __init__(self) -> None:
        self._started = time.perf_counter()
        self.any: float | None = None
        self.true_light: float | None = None

    def add(self, is_true: bool) -> None:
        """A picture was sent now; is_true: it is lit by the scene's lights."""
        seconds = time.perf_counter() - self._started
        self.any = self.any or seconds
        if is_true:
            self.true_light = self.true_light or seconds


def look(context: Context, library: ProgramLibrary, scene: Scene) -> Found:
    """Seconds to the first pictures of a scene in a viewport."""

    def take(kind: str, **content: object) -> None:
        if kind == "frame":
            found.add(content["progress"] > 0.0)

    renderer = ViewportRenderer(context, library, Denoiser([]), take, KnownPrograms())
    found = Found()
    renderer.show(scene, 1, False)
    while found.true_light is None:
        renderer.run_slice()
    renderer.release()
    return found


def render(context: Context, library: ProgramLibrary, scene: Scene) -> Found:
    """Seconds to the first pictures of a scene that F12 renders."""

    def take(kind: str, **content: object) -> None:
        if kind in ("picture", "result"):
            found.add(kind == "result" or content["progress"]["iteration"] > 0)
            rendering.received()
        elif kind == "progress" and content["progress"]["iteration"] == 1:
            rendering.request_picture()

    rendering = Rendering(context, library, Denoiser([]), take, KnownPrograms(), has_first_look=True)
    found = Found()
    rendering.show(scene, 1, False)
    rendering.request_picture()
    while found.true_light is None:
        rendering.run_slice()
    rendering.release()
    return found


_MEASURES = {"viewport": look, "F12": render}


def measure_here(path: str, way: str, size: tuple[int, int]) -> None:
    """Print what one way shows of a file, in this process."""
    context = Context.create()
    bpy.ops.wm.open_mainfile(filepath=path, load_ui=False, use_scripts=False)
    scene = export_scene(bpy.context.evaluated_depsgraph_get())
    scene.camera = camera_at_resolution(dataclasses.replace(scene.camera, crop=None), *size)
    scene.settings = dataclasses.replace(scene.settings, passes=(), iterations=1024, time_limit=0.0)
    found = _MEASURES[way](context, ProgramLibrary(context), scene)
    print(_RESULT + json.dumps([found.any, found.true_light]), flush=True)


def measure(path: str, way: str, size: tuple[int, int], caches: str) -> tuple[float, float]:
    """Seconds to the first picture and to the first in true light, in a process with these caches."""
    command = [sys.executable, "-m", "benchmarks.first_picture", path, "--way", way, "--size", "{}x{}".format(*size)]
    environment = os.environ | {"RPPM_CACHE": caches, "MESA_SHADER_CACHE_DIR": caches}
    done = subprocess.run(command, cwd=ROOT, env=environment, check=True, capture_output=True, text=True)
    line = next(line for line in done.stdout.splitlines() if line.startswith(_RESULT))
    first, true_light = json.loads(line.removeprefix(_RESULT))
    return first, true_light


def row(path: str, size: tuple[int, int]) -> str:
    """A scene's row of the table."""
    cells = [Path(path).stem]
    for way in _MEASURES:
        with tempfile.TemporaryDirectory() as caches:
            for _ in ("empty", "full"):
                cells += [f"{seconds:.2f}" for seconds in measure(path, way, size, caches)]
    return "| " + " | ".join(cells) + " |"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", metavar="FILE.blend")
    parser.add_argument("--size", type=lambda text: tuple(map(int, text.split("x"))), default=(320, 180))
    parser.add_argument("--way", choices=_MEASURES, help=argparse.SUPPRESS)
    options = parser.parse_args()
    rppm_addon.register()
    if options.way is not None:
        measure_here(options.files[0], options.way, options.size)
        return
    caches = ("empty", "full")
    states = [f"{way}, {state} caches: {what}" for way in _MEASURES for state in caches for what in _PICTURES]
    print("| scene | " + " | ".join(states) + " |")
    print("|---|" + "--:|" * len(states))
    for path in options.files:
        print(row(str(Path(path).resolve()), options.size), flush=True)


if __name__ == "__main__":
    main()
    sys.stdout.flush()
    os._exit(0)  # Blender's own exit may hang
