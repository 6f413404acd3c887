# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures the error of pictures by their first radius: Eq. 3's at several scales, and adaptive radii.

Prints a table. Scenes are files of ``rppm export``.
"""

import argparse
from pathlib import Path

import numpy as np

from rppm_addon.commands.saved_scene import camera_at_resolution
from rppm_addon.gl.context.context import Context
from rppm_addon.gl.programs.programs import ProgramLibrary
from rppm_addon.integrator.progressive import ProgressivePhotonMapper
from rppm_addon.scene import Scene, load_scene

from . import ROOT

REFERENCE = {"radius_scale": 8.0, "use_adaptive_radius": False, "seed": 77}
WORST = 0.001
"""Share of the pixels, the worst ones, that errors leave out."""


def relative_error(picture: np.ndarray, reference: np.ndarray) -> float:
    """Mean of squared errors over the squared reference + 0.01, both (height, width, 3)."""
    errors = np.square(picture - reference).mean(-1) / (np.square(reference).mean(-1) + 0.01)
    return float(np.sort(errors.ravel())[: int(errors.size * (1.0 - WORST))].mean())


def pictures(mapper: ProgressivePhotonMapper, scene: Scene, iterations: list[int], **settings: object):
    """(height, width, 3) radiance after each number of iterations."""
    scene.settings = scene.settings.with_values(**settings)
    mapper.build(scene)
    for last in iterations:
        while mapper.iteration < last:
            mapper.iterate()
        yield mapper.film.read_radiance()[..., :3]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scenes", nargs="+", type=Path)
    parser.add_argument("--size", type=int, default=128)
    parser.add_argument("--photons", type=int, default=65536)
    parser.add_argument("--iterations", type=int, nargs="+", default=[8, 32])
    parser.add_argument("--scales", type=float, nargs="+", default=[10.0, 15.0, 30.0])
    parser.add_argument("--reference-iterations", type=int, default=200)
    parser.add_argument("--references", type=Path, default=ROOT / "out/benchmarks/radii")
    options = parser.parse_args()
    context = Context.create(None)
    mapper = ProgressivePhotonMapper(context, ProgramLibrary(context))
    ways = {f"s_r {scale:g}": {"radius_scale": scale, "use_adaptive_radius": False} for scale in options.scales}
    ways["adaptive"] = {"radius_scale": 10.0, "use_adaptive_radius": True}
    print("| scene |", " | ".join(ways), "|")
    print("|---|" + "---:|" * len(ways))
    for path in options.scenes:
        scene = load_scene(path).expanded()
        scene.camera = camera_at_resolution(scene.camera, options.size, options.size)
        scene.settings.photons = options.photons
        kept = options.references / f"{path.stem}_{options.size}.npy"
        if not kept.exists():
            kept.parent.mkdir(parents=True, exist_ok=True)
            np.save(kept, next(pictures(mapper, scene, [options.reference_iterations], **REFERENCE)))
        reference = np.load(kept)
        cells = []
        for settings in ways.values():
            found = pictures(mapper, scene, options.iterations, seed=0, **settings)
            cells.append(" / ".join(f"{relative_error(picture, reference):.5f}" for picture in found))
        print("|", path.stem, "|", " | ".join(cells), "|", flush=True)


if __name__ == "__main__":
    main()
