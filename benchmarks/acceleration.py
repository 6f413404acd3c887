# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures iterations through the deep cubemap and through the BVH, in turns, and how far apart their pictures are.

Takes scenes that `rppm export` wrote; without any, a box with a glass and a mirror sphere. Prints a table.
"""

import dataclasses
import statistics
import sys

import numpy as np

from rppm_addon.gl.context.context import Context
from rppm_addon.gl.programs.programs import ProgramLibrary
from rppm_addon.integrator.progressive import ProgressivePhotonMapper
from rppm_addon.scene import AccelerationStructure, Scene

from .machine import Clock
from .route_comparison import named_scenes, parse

STRUCTURES = AccelerationStructure.DEEP_CUBEMAP, AccelerationStructure.BVH
TRACING = "camera tracing", "photon tracing", "first photon hits", "direct light"
"""Stages most of whose time goes into rays."""
_LEARNING = 9
"""Iterations that are not counted, in which programs are compiled and photons find where they are of use."""


def measure(
    context: Context, library: ProgramLibrary, clock: Clock, scene: Scene, iterations: int
) -> tuple[np.ndarray, float]:
    """(structures, 4): seconds of a build, of an iteration and of its stages that trace, medians; MiB on the device.
    And the relative root mean square by which the two pictures differ."""
    mappers = []
    for structure in STRUCTURES:
        mapper = ProgressivePhotonMapper(context, library)
        mapper.timers.begin(clock.now)
        settings = dataclasses.replace(scene.settings, acceleration_structure=structure)
        mapper.build(dataclasses.replace(scene, settings=settings))
        for _ in range(_LEARNING):
            mapper.iterate()
        mappers.append(mapper)
    figures: list[list[tuple[float, float]]] = [[], []]
    for _ in range(iterations):
        for mapper, seconds in zip(mappers, figures, strict=True):
            mapper.timers.reset()
            total = clock.once(mapper.iterate)
            seconds.append((total, sum(mapper.timers.seconds.get(stage, 0.0) for stage in TRACING)))
    films = [mapper.film.read_radiance()[..., :3].astype(float) for mapper in mappers]
    difference = float(np.sqrt(np.mean((films[0] - films[1]) ** 2)) / np.mean(films[0]))
    rows = []
    for mapper, structure, seconds in zip(mappers, STRUCTURES, figures, strict=True):
        mebibytes = sum(mapper.acceleration.memory_bytes.values()) / 2**20
        whole, geometry = mapper.scene, mapper.device_scene.geometry
        choice = mapper.device_scene.acceleration
        builds = [clock.once(lambda: choice.build(whole, geometry, structure)) for _ in range(3)]  # noqa: B023
        rows.append([statistics.median(builds), *np.median(seconds, axis=0), mebibytes])
        mapper.release()
    return np.array(rows), difference


def main(arguments: list[str] | None = None) -> int:
    options = parse(__doc__, arguments, iterations=5)
    context = Context.create()
    library, clock = ProgramLibrary(context), Clock(context)
    print(f"{context.information.name}; {clock.description}\n")
    print("| scene | triangles | build, s: deep cubemap | BVH | iteration, s: deep cubemap | BVH | ratio |", end=" ")
    print(
        "tracing and direct light, s: deep cubemap | BVH | ratio | MiB: deep cubemap | BVH | difference |\n|---|"
        + 12 * "---:|"
    )
    for name, scene in named_scenes(options):
        (cubemap, bvh), difference = measure(context, library, clock, scene, options.iterations)
        cells = [f"{scene.triangle_count:,}", f"{cubemap[0]:.3g}", f"{bvh[0]:.3g}"]
        for column in (1, 2):
            cells += [
                f"{cubemap[column]:.3g}",
                f"{bvh[column]:.3g}",
                f"{bvh[column] / cubemap[column]:.2f}",
            ]
        cells += [f"{cubemap[3]:.1f}", f"{bvh[3]:.1f}", f"{difference:.1g}"]
        print(f"| {name} |", " | ".join(cells), "|", flush=True)
    context.release()
    return 0


if __name__ == "__main__":
    sys.exit(main())
