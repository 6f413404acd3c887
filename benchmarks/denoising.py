# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures what denoising does to pictures of so many samples: their error, and how sharp caustics stay.

Prints a table. Scenes are files of ``rppm export``, references those of make bench-peers (reference.npz).
"""

import argparse
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from rppm_addon.commands.saved_scene import camera_at_resolution
from rppm_addon.denoising.denoiser import Denoiser
from rppm_addon.denoising.places import library_places
from rppm_addon.scene import Scene, load_scene
from rppm_addon.scene.passes import DENOISING_ALBEDO, DENOISING_NORMAL
from rppm_addon.scene.settings import DenoisingInputPasses, DenoisingPrefilter, RenderSettings
from rppm_addon.session.render.renderer import Renderer
from rppm_addon.session.render.results import Frame

from .peers.metrics import caustic_mask, displayed, exposure_of, flip, gradients_kept, relative_mse

WAYS = {
    "noisy": None,
    "alone": (DenoisingInputPasses.RGB, DenoisingPrefilter.NONE),
    "albedo": (DenoisingInputPasses.RGB_ALBEDO, DenoisingPrefilter.ACCURATE),
    "albedo, normal; none": (DenoisingInputPasses.RGB_ALBEDO_NORMAL, DenoisingPrefilter.NONE),
    "albedo, normal; fast": (DenoisingInputPasses.RGB_ALBEDO_NORMAL, DenoisingPrefilter.FAST),
    "albedo, normal; accurate": (DenoisingInputPasses.RGB_ALBEDO_NORMAL, DenoisingPrefilter.ACCURATE),
}
"""Input passes that guide the denoiser and their prefilter, by name; None for the noisy picture."""


def frames(renderer: Renderer, scene: Scene, samples: list[int]) -> Iterator[tuple[int, Frame]]:
    """Noisy pictures with what guides, after so many samples each."""
    found = []
    scene.settings = scene.settings.with_values(
        iterations=max(samples), use_denoising=False, passes=(DENOISING_ALBEDO, DENOISING_NORMAL)
    )
    renderer.render(
        scene, lambda progress, read: found.append((progress.iteration, read())) if progress.iteration in samples else 0
    )
    yield from found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scene", type=Path, metavar="SCENE.npz")
    parser.add_argument("reference", type=Path, metavar="reference.npz")
    parser.add_argument("--samples", type=int, nargs="+", default=[8, 32])
    parser.add_argument("--save", type=Path, metavar="FOLDER", help="keep the pictures there")
    options = parser.parse_args()
    scene, denoiser = load_scene(options.scene), Denoiser(library_places())
    with np.load(options.reference) as arrays:
        reference, without = arrays["pixels"], arrays.get("without")
    scene.camera = camera_at_resolution(scene.camera, *reference.shape[1::-1])
    exposure = exposure_of(reference)
    mask = np.ones(reference.shape[:2], bool) if without is None else caustic_mask(reference, without)
    print(
        "| samples | guided by | relMSE | FLIP | gradients kept | energy | mean | seconds |\n"
        + "|---|---"
        + "|---:" * 6
        + "|"
    )
    with Renderer() as renderer:
        for count, frame in frames(renderer, scene, options.samples):
            for name, way in WAYS.items():
                started, picture = time.perf_counter(), frame.combined
                if way is not None:
                    settings = RenderSettings(
                        use_denoising=True, denoising_input_passes=way[0], denoising_prefilter=way[1]
                    )
                    picture = denoiser.denoise(frame.combined, frame.passes, settings)
                seconds = time.perf_counter() - started
                pixels = picture[::-1, :, :3]
                if options.save is not None:
                    options.save.mkdir(parents=True, exist_ok=True)
                    np.save(options.save / f"{options.scene.stem}_{count}_{name}.npy", pixels)
                shown = displayed(pixels, exposure), displayed(reference, exposure)
                kept, energy = gradients_kept(*shown, mask)
                print(
                    f"| {count} | {name} | {relative_mse(pixels, reference):.5f} "
                    f"| {flip(pixels, reference, exposure):.4f} | {kept:.2f} | {energy:.2f} "
                    f"| {pixels.mean() / frame.combined[..., :3].mean():.4f} | {seconds:.2f} |",
                    flush=True,
                )


if __name__ == "__main__":
    main()
