# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures both routes to photons' first hits, in turns, and checks that they give the same bits.

Takes scenes that `rppm export` wrote; without any, a box with a glass and a mirror sphere. Point lights, a spot and
suns take the place of the strongest light, each alone. Prints a table.
"""

import dataclasses
import sys

import numpy as np

from rppm_addon.gl.context.context import Context
from rppm_addon.gl.programs.programs import ProgramLibrary
from rppm_addon.integrator.progressive import ProgressivePhotonMapper
from rppm_addon.scene import FirstPhotonHits, LightKind, Scene

from .machine import Clock
from .route_comparison import named_scenes, parse

ROUTES = FirstPhotonHits.RASTERIZED, FirstPhotonHits.TRACED
STAGES = "emission", "first photon hits"
LIGHTS = {
    "point": {"kind": LightKind.POINT, "radius": 0.0},
    "point, radius 0.5 % of the scene's": {"kind": LightKind.POINT},
    "spot": {"kind": LightKind.SPOT, "radius": 0.0, "spot_angle": 1.6, "spot_blend": 0.2},
    "sun, parallel": {"kind": LightKind.SUN, "sun_angle": 0.0},
    "sun, 0.53 degrees": {"kind": LightKind.SUN, "sun_angle": 0.00925},
}
_LEARNING = 5
"""Iterations that are not counted: photons go where they are of use from the sixth on as from the second on."""


def with_light(scene: Scene, name: str) -> Scene:
    values = {"strength": np.full(3, 10.0), "graph": None} | LIGHTS[name]
    if "radius" not in values:
        corners = [
            scene.meshes[item.mesh].positions @ item.matrix[:3, :3].T + item.matrix[:3, 3]
            for item in scene.expanded().instances
        ]
        values["radius"] = 0.005 * 0.5 * float(np.linalg.norm(np.ptp(np.concatenate(corners), axis=0)))
    strongest = max(scene.lights, key=lambda light: float(np.mean(light.strength)))
    return dataclasses.replace(scene, lights=[dataclasses.replace(strongest, **values)])


def measure(context: Context, library: ProgramLibrary, clock: Clock, scene: Scene, iterations: int) -> np.ndarray:
    """(routes, 4): the least seconds of emission with first hits, of an iteration, seconds of the iteration in which
    light G-buffers are made beyond that, and MiB of photon paths."""
    mappers: list[ProgressivePhotonMapper] = []
    figures: list[list[tuple[float, float]]] = [[], []]
    anew = []
    for route in ROUTES:
        mapper = ProgressivePhotonMapper(context, library)
        mapper.timers.begin(clock.now)
        mapper.build(dataclasses.replace(scene, settings=dataclasses.replace(scene.settings, first_photon_hits=route)))
        for _ in range(_LEARNING):
            mapper.iterate()
        mappers.append(mapper)

    def stages(mapper: ProgressivePhotonMapper) -> tuple[float, float]:
        mapper.timers.reset()
        total = clock.once(mapper.iterate)
        return sum(mapper.timers.seconds[stage] for stage in STAGES), total

    for _ in range(iterations):
        for mapper, seconds in zip(mappers, figures, strict=True):
            seconds.append(stages(mapper))
    least = np.min(figures, axis=1)
    for mapper, (seconds, _) in zip(mappers, least, strict=True):
        mapper.stages.photons.first_hits.forget()
        anew.append(max(stages(mapper)[0] - seconds, 0.0))
    films = [mapper.film.read_radiance().view(np.uint32) for mapper in mappers]
    if not np.array_equal(*films):
        raise SystemExit("the two routes give different pictures")
    mebibytes = [sum(mapper.memory.working["photon paths"].values()) / 2**20 for mapper in mappers]
    for mapper in mappers:
        mapper.release()
    return np.column_stack([least, anew, mebibytes])


def main(arguments: list[str] | None = None) -> int:
    options = parse(__doc__, arguments, iterations=4)
    context = Context.create()
    library, clock = ProgramLibrary(context), Clock(context)
    print(f"{context.information.name}; {clock.description}\n")
    print("| scene | light | emission and first hits, ms: traced | rasterized | ratio |", end=" ")
    print("iteration, ms: traced | rasterized | ratio | making them, ms | memory, MiB |\n|---|---|" + 8 * "---:|")
    for name, scene in named_scenes(options):
        for light in LIGHTS:
            rasterized, traced = measure(context, library, clock, with_light(scene, light), options.iterations)
            cells = [f"{1e3 * b:.3g} | {1e3 * a:.3g} | {a / b:.2f}" for a, b in zip(rasterized[:2], traced[:2])]
            cells += [f"{1e3 * rasterized[2]:.3g}", f"{rasterized[3] - traced[3]:.1f}"]
            print(f"| {name} | {light} |", " | ".join(cells), "|", flush=True)
    context.release()
    return 0


if __name__ == "__main__":
    sys.exit(main())
