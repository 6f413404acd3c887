# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures both routes of density estimation, in turns, and checks that they give the same bits.

Takes scenes that `rppm export` wrote; without any, a box with a glass and a mirror sphere. Prints a table.
"""

import dataclasses
import sys

import numpy as np

from rppm_addon.gl.context.context import Context
from rppm_addon.gl.programs.programs import ProgramLibrary
from rppm_addon.integrator.progressive import ProgressivePhotonMapper
from rppm_addon.scene import DensityEstimation, Scene

from .machine import Clock
from .route_comparison import named_scenes, parse

ROUTES = DensityEstimation.RASTERIZED, DensityEstimation.GRID
STAGES = "direct splatting", "indirect splatting"


def measure(context: Context, library: ProgramLibrary, clock: Clock, scene: Scene, iterations: int) -> np.ndarray:
    """(routes, 3): the least seconds of density estimation and of an iteration, and MiB of density estimation.

    One iteration before is not counted.
    """
    mappers, figures = [], []
    for route in ROUTES:
        mapper = ProgressivePhotonMapper(context, library)
        mapper.timers.begin(clock.now)
        mapper.build(dataclasses.replace(scene, settings=dataclasses.replace(scene.settings, density_estimation=route)))
        mapper.iterate()
        mappers.append(mapper)
        figures.append([])
    for _ in range(iterations):
        for mapper, seconds in zip(mappers, figures, strict=True):
            mapper.timers.reset()
            total = clock.once(mapper.iterate)
            seconds.append((sum(mapper.timers.seconds[stage] for stage in STAGES), total))
    films = [mapper.film.read_radiance().view(np.uint32) for mapper in mappers]
    if not np.array_equal(*films):
        raise SystemExit("the two routes give different pictures")
    mebibytes = [sum(mapper.memory.working["density estimation"].values()) / 2**20 for mapper in mappers]
    for mapper in mappers:
        mapper.release()
    return np.column_stack([np.min(figures, axis=1), mebibytes])


def main(arguments: list[str] | None = None) -> int:
    options = parse(__doc__, arguments, iterations=2)
    context = Context.create()
    library, clock = ProgramLibrary(context), Clock(context)
    print(f"{context.information.name}; {clock.description}\n")
    quantities = "density estimation, s", "iteration, s", "memory, MiB"
    print("| scene |", " | ".join(f"{name}: rasterized | grid | ratio" for name in quantities), "|")
    print("|---|" + 9 * "---:|")
    for name, scene in named_scenes(options):
        rasterized, grid = measure(context, library, clock, scene, options.iterations)
        cells = [f"{a:.3g} | {b:.3g} | {a / b:.1f}" for a, b in zip(rasterized, grid, strict=True)]
        print("|", name, "|", " | ".join(cells), "|", flush=True)
    context.release()
    return 0


if __name__ == "__main__":
    sys.exit(main())
