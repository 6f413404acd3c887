# SPDX-License-Identifier: GPL-3.0-or-later
"""The current Blender scene, rendered with Cycles and with RPPM.

Both engines get the same scene: Cycles through bpy.ops.render.render, RPPM through the extension's exporter and a
Renderer.
"""

import os
import tempfile

import bpy
import numpy as np
import OpenEXR
import pytest

from rppm_addon.blender.export import export_scene
from rppm_addon.scene import Scene
from rppm_addon.session.render.renderer import Renderer
from rppm_addon.session.render.results import Frame

from . import references
from .comparison import CONVERGED, Tolerance, compare

FIRST_SEED = 1000
PIXEL_CENTERS = {"filter_width": 0.0, "iterations": 1, "photons": 64}
"""RPPM's settings for what has no noise, seen through the middles of pixels, as Cycles sees it after unfilter()."""


def render_cycles(samples: int, seeds: int = 2) -> np.ndarray:
    """(seeds, height, width, 3) float64 scene-linear pictures, row 0 at the bottom."""
    return _cycles_pictures(samples, seeds)[..., :3]


def render_cycles_over(background: float, samples: int, seeds: int = 2) -> np.ndarray:
    """render_cycles with a transparent film, laid over an even background of some radiance."""
    bpy.context.scene.render.film_transparent = True
    pictures = _cycles_pictures(samples, seeds)
    bpy.context.scene.render.film_transparent = False
    return pictures[..., :3] + background * (1.0 - pictures[..., 3:])


def _cycles_pictures(samples: int, seeds: int) -> np.ndarray:
    """(seeds, height, width, 4) float64, premultiplied by alpha; without noise if of a single sample."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples = samples
    scene.cycles.seed = FIRST_SEED
    if samples == 1:
        return _render_seeds(seeds)
    return references.light(lambda: _render_seeds(seeds), seeds)


def _render_seeds(seeds: int) -> np.ndarray:
    scene = bpy.context.scene
    pictures = []
    for seed in range(seeds):
        scene.cycles.seed = FIRST_SEED + seed
        pictures.append(cycles_pass("Combined", "RGBA", scene.cycles.samples))
    return np.array(pictures, np.float64)


def unfilter() -> None:
    """Have Cycles look through the middles of pixels, or next to them."""
    cycles = bpy.context.scene.cycles
    cycles.pixel_filter_type, cycles.filter_width = "GAUSSIAN", 0.01


def cycles_channels(samples: int = 1) -> dict[str, np.ndarray]:
    """Return Cycles' view layer by pass and channel ("Depth.Z"): (H, W) float32, row 0 at the bottom."""
    scene = bpy.context.scene
    scene.render.engine, scene.cycles.samples = "CYCLES", samples
    return _render_channels()


def stacked(channels: dict[str, np.ndarray], name: str, letters: str = "RGB") -> np.ndarray:
    """(H, W, letters) of a pass among those of cycles_channels()."""
    return np.stack([channels[f"{name}.{letter}"] for letter in letters], axis=-1)


def cycles_pass(name: str = "Combined", letters: str = "RGB", samples: int = 1) -> np.ndarray:
    """Cycles' pass, (H, W, letters) float32, row 0 at the bottom."""
    return stacked(cycles_channels(samples), name, letters)


def render_final(samples: int, seeds: int = 3) -> np.ndarray:
    """(seeds, height, width, 3) float64, row 0 at the bottom: what RPPM gives as Blender's render engine, of what
    Blender evaluates for renders and not for viewports."""
    if references.only_cycles():
        pytest.skip("only Cycles' side")
    scene = bpy.context.scene
    scene.render.engine, scene.rppm.samples, scene.rppm.photons = "RPPM", samples, 256
    pictures = []
    for seed in range(seeds):
        scene.rppm.seed = seed
        pictures.append(stacked(_render_channels(), "Combined"))
    return np.array(pictures, np.float64)


def _render_channels() -> dict[str, np.ndarray]:
    scene = bpy.context.scene
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = os.path.join(folder, "picture.exr")
        bpy.ops.render.render(write_still=True)
        with OpenEXR.File(scene.render.filepath, separate_channels=True) as file:  # each pass is a part of its own
            channels = {name: channel.pixels for part in file.parts for name, channel in part.channels.items()}
    return {name.partition(".")[2]: pixels[::-1] for name, pixels in channels.items()}


def exported_scene() -> Scene:
    """The current Blender scene as RPPM sees it. Tests of shadow catchers know what these leave out."""
    scene = export_scene(bpy.context.evaluated_depsgraph_get())
    warnings = [text for text in scene.warnings if not text.startswith("Shadow Catcher")]
    assert warnings == [], warnings
    return scene


def render_frame(renderer: Renderer, **settings: object) -> Frame:
    """RPPM's frame of the current Blender scene; settings by the names of RenderSettings."""
    scene = exported_scene()
    scene.settings = scene.settings.with_values(**settings)
    return renderer.render(scene).frame


def render_rppm(renderer: Renderer, seeds: int = 3, **settings: object) -> np.ndarray:
    """(seeds, height, width, 3) float64 pictures of the current Blender scene, row 0 at the bottom.

    settings: by the names of RenderSettings.
    """
    scene = exported_scene()
    pictures = []
    for seed in range(seeds):
        scene.settings = scene.settings.with_values(seed=seed, **settings)
        pictures.append(renderer.render(scene).frame.combined[..., :3].astype(np.float64))
    return np.array(pictures)


def compare_with_cycles(
    renderer: Renderer, name: str, samples: int, tolerance: Tolerance = CONVERGED, **settings: object
) -> tuple[np.ndarray, np.ndarray]:
    """Render the current Blender scene with both engines and assert that the pictures agree.

    samples: Cycles'. settings: of render_rppm(). Returns RPPM's pictures and Cycles', (seeds, H, W, 3) float64.
    """
    reference = render_cycles(samples)
    pictures = render_rppm(renderer, **settings)
    compare(name, pictures, reference, tolerance)
    return pictures, reference
