# SPDX-License-Identifier: GPL-3.0-or-later
"""Command line and scenes of benchmarks that compare two routes to the same picture."""

import argparse
import dataclasses
from collections.abc import Iterator
from pathlib import Path

import scenes

from rppm_addon.commands.saved_scene import camera_at_resolution
from rppm_addon.scene import Scene, load_scene


def parse(description: str, arguments: list[str] | None, iterations: int) -> argparse.Namespace:
    """Scenes, size, photons, and iterations that are timed, by default so many."""
    parser = argparse.ArgumentParser(description=description.splitlines()[0])
    parser.add_argument("scenes", type=Path, nargs="*", metavar="SCENE.npz")
    parser.add_argument("--size", type=int, default=256, metavar="N", help="pixels a side (256)")
    parser.add_argument("--photons", type=int, default=65536, metavar="N", help="an iteration (65536)")
    parser.add_argument(
        "--iterations", type=int, default=iterations, metavar="N", help=f"iterations that are timed ({iterations})"
    )
    return parser.parse_args(arguments)


def named_scenes(options: argparse.Namespace) -> Iterator[tuple[str, Scene]]:
    """The scenes asked for, without any a box with a glass and a mirror sphere, as they are to be rendered."""
    for path in options.scenes or [None]:
        scene = scenes.room(options.size) if path is None else load_scene(path).expanded()
        camera = camera_at_resolution(dataclasses.replace(scene.camera, crop=None), options.size, options.size)
        settings = dataclasses.replace(scene.settings, photons=options.photons)
        yield (
            "box with spheres" if path is None else path.stem,
            dataclasses.replace(scene, camera=camera, settings=settings),
        )
