# SPDX-License-Identifier: GPL-3.0-or-later
"""Predicted cost of every program of an iteration: ``python -m benchmarks.predictions.run``.

Without options programs count on this machine what they ask of memory, at two sizes of the picture, and the
page docs/benchmarks/predictions.md is written. --measure times them on the device that there is and prints both.
"""

import argparse
import dataclasses
import json
import os
import sys
import tempfile
from pathlib import Path

from rppm_addon.commands.saved_scene import camera_at_resolution
from rppm_addon.gl.context.context import Context
from rppm_addon.gl.programs.programs import ProgramLibrary
from rppm_addon.integrator.progressive import ProgressivePhotonMapper
from rppm_addon.scene import DensityEstimation, RenderSettings, Scene, load_scene
from rppm_addon.scene.errors import RppmError

from .measuring import KernelTimes, comparison
from .model import Demand, demands
from .recorder import Recorder

FILE = Path(__file__).resolve().parent / "demands.json"
PIXELS = 1 << 20
"""Number of pixels in the paper, with 262,144 photons."""
SIZES, ITERATIONS = (64, 160), 2
ROUTES = (DensityEstimation.RASTERIZED, DensityEstimation.GRID)


def scene_at(scene: Scene, side: int, route: DensityEstimation) -> Scene:
    """A scene as the paper renders its own: 3 + 3 segments and a photon for four pixels; a square picture."""
    settings: RenderSettings = dataclasses.replace(
        scene.settings,
        photons=side * side // 4,
        photon_path_length=3,
        camera_path_length=3,
        density_estimation=route,
    )
    camera = camera_at_resolution(dataclasses.replace(scene.camera, crop=None), side, side)
    return dataclasses.replace(scene, camera=camera, settings=settings)


def count(scene: Scene) -> dict[str, Demand]:
    """Have the programs of both routes count."""
    context = Context.create()
    found: dict[str, Demand] = {}
    with tempfile.TemporaryDirectory() as folder:
        os.environ["RPPM_CACHE"] = folder
        recorder = Recorder(context)
        with recorder.recording():
            mapper = ProgressivePhotonMapper(context, ProgramLibrary(context))
            for route in ROUTES:
                rows = []
                for side in SIZES:
                    mapper.build(scene_at(scene, side, route))
                    for _ in range(ITERATIONS):  # lists find their lengths, programs are made
                        mapper.iterate()
                    recorder.reset()
                    for _ in range(ITERATIONS):
                        mapper.iterate()
                    rows.append(recorder.read())
                    print(f"{route.value} at {side} x {side}: {len(rows[-1])} programs", flush=True)
                found = demands([side * side for side in SIZES], rows, ITERATIONS) | found
    return found


def measure(scene: Scene, pixels: int, stored: dict[str, Demand], iterations: int) -> str:
    """Time each program on this device; returns a table beside what was predicted."""
    context = Context.create()
    mapper = ProgressivePhotonMapper(context, ProgramLibrary(context))
    side = round(pixels**0.5)
    seconds: dict[str, float] = {}
    for route in ROUTES:
        mapper.build(scene_at(scene, side, route))
        for _ in range(3):
            mapper.iterate()
        with KernelTimes(context) as times:
            for _ in range(iterations):
                mapper.iterate()
            for name, total in times.seconds().items():
                seconds.setdefault(name, total / iterations)
    return comparison(context.information.name, side * side, stored, seconds)


def parse(arguments: list[str] | None = None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene", type=Path, nargs="?", help="a saved scene (rppm export docs/samples/pool.blend)")
    parser.add_argument("--measure", action="store_true", help="time the programs here beside what was predicted")
    parser.add_argument("--pixels", type=int, default=PIXELS, help=f"of what is timed ({PIXELS})")
    parser.add_argument("--iterations", type=int, default=8, help="that are timed (8)")
    parser.add_argument("--page", action="store_true", help="only write the page anew")
    options = parser.parse_args(arguments)
    if options.scene is None and not options.page:
        parser.error("a saved scene is needed")
    return options


def main() -> int:
    """Do it; returns the exit status."""
    options = parse()
    try:
        if options.measure or options.page:
            stored = {name: Demand.of(values) for name, values in json.loads(FILE.read_text(encoding="utf-8")).items()}
        if options.measure:
            print(measure(load_scene(options.scene).expanded(), options.pixels, stored, options.iterations))
            return 0
        from .page import write_page  # late: needs the lab of drivers

        if not options.page:
            stored = count(load_scene(options.scene).expanded())
            FILE.write_text(json.dumps({name: d.as_dict() for name, d in stored.items()}, indent=1) + "\n", "utf-8")
        write_page(stored, PIXELS)
    except (RppmError, OSError) as error:
        print(f"predictions: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
