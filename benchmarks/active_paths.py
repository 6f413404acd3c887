# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures what lists of active paths save: iterations with them and with all paths in every segment, in turns.

Prints a table. Scenes are files of ``rppm export``.
"""

import argparse
from contextlib import contextmanager
from pathlib import Path
from unittest import mock

import numpy as np

from rppm_addon.commands.saved_scene import camera_at_resolution
from rppm_addon.gl.context.context import Context
from rppm_addon.gl.programs.programs import ProgramLibrary
from rppm_addon.integrator.common.active_paths import ActivePaths
from rppm_addon.integrator.progressive import ProgressivePhotonMapper
from rppm_addon.scene import load_scene

from .machine import Clock

STAGES = {
    "photon paths": ("first photon hits", "photon tracing", "photon resolve", "photon scattering"),
    "camera paths": ("camera tracing", "camera resolve", "camera scattering"),
    "direct light": ("direct light",),
    "density estimation": ("direct splatting", "indirect splatting"),
}


@contextmanager
def all_paths():
    """Lists that keep every path: programs then run for all, as if there were no lists."""
    with (
        mock.patch.object(ActivePaths, "keep", lambda paths, rays: None),
        mock.patch.object(ActivePaths, "take", lambda paths, others, rays: paths.fill(others.capacity)),
    ):
        yield


def measure(scene: Path, context: Context, library: ProgramLibrary, options: argparse.Namespace) -> list[str]:
    """A row of the table. Raises AssertionError when the pictures differ in a bit."""
    clock, mappers = Clock(context), {}
    for name in ("all", "active"):
        loaded = load_scene(scene).expanded()
        loaded.camera = camera_at_resolution(loaded.camera, options.size, options.size)
        loaded.settings.photons = options.photons
        mappers[name] = ProgressivePhotonMapper(context, library)
        mappers[name].build(loaded)
        mappers[name].timers.begin(clock.now)
    best: dict[tuple[str, str], float] = {}
    for _ in range(options.iterations):
        for name, mapper in mappers.items():
            mapper.timers.reset()
            if name == "all":
                with all_paths():
                    whole = clock.once(mapper.iterate)
            else:
                whole = clock.once(mapper.iterate)
            seconds = mapper.timers.seconds
            parts = {part: sum(seconds.get(stage, 0.0) for stage in stages) for part, stages in STAGES.items()}
            for part, value in (parts | {"iteration": whole}).items():
                best[name, part] = min(best.get((name, part), value), value)
        films = [mapper.film.read_radiance() for mapper in mappers.values()]
        assert np.array_equal(*films), scene
    for mapper in mappers.values():
        mapper.release()
    cells = [scene.stem]
    for part in (*STAGES, "iteration"):
        before, after = best["all", part], best["active", part]
        cells.append(f"{1e3 * before:.0f} -> {1e3 * after:.0f} ({after / before:.2f})")
    return cells


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scenes", nargs="+", type=Path)
    parser.add_argument("--size", type=int, default=256, help="pixels along a side")
    parser.add_argument("--photons", type=int, default=65536)
    parser.add_argument("--iterations", type=int, default=3)
    options = parser.parse_args()
    context = Context.create()
    library = ProgramLibrary(context)
    print("| scene |", " | ".join(STAGES), "| iteration |")
    print("|---|" + "---:|" * (len(STAGES) + 1))
    for scene in options.scenes:
        print("|", " | ".join(measure(scene, context, library, options)), "|", flush=True)


if __name__ == "__main__":
    main()
