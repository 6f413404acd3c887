# SPDX-License-Identifier: GPL-3.0-or-later
"""Features and settings of scenes that RPPM does not render by, or not as Cycles does."""

import bpy

from .omission import Omission, of_cycles

_OWN_PATTERNS = {"AUTOMATIC", "TABULATED_SOBOL"}
"""Sampling patterns that users need not have chosen: Cycles' own choice, and what it gives older files."""


def _has_transparent_glass_of_cycles_only(scene: bpy.types.Scene) -> bool:
    own = getattr(getattr(scene, "rppm", None), "film_transparent_glass", False)
    return scene.render.film_transparent and bool(of_cycles(scene, "film_transparent_glass", False)) and not own


OF_SCENES = (
    Omission(
        "Biased volumes",
        "light passes voxels exactly, as in Cycles without Biased; Step Rate and Max Steps have no effect",
        ("cycles.volume_biased",),
        lambda scene: bool(of_cycles(scene, "volume_biased", False)),
    ),
    Omission(
        "Transparent Glass",
        "on for Cycles only, so that glass is opaque in the transparent film; switch it on in Film, or take all of "
        "Cycles' settings with Sampling > Advanced > Copy from Cycles",
        ("render.film_transparent", "cycles.film_transparent_glass"),
        _has_transparent_glass_of_cycles_only,
    ),
    Omission(
        "Fast GI Approximation",
        "indirect light is followed to its end, as with the approximation off; no distance of ambient occlusion counts",
        ("cycles.use_fast_gi",),
        lambda scene: bool(of_cycles(scene, "use_fast_gi", False)),
    ),
    Omission(
        "Sample Subset",
        "all samples are rendered; rppm render --samples-range renders some of them, and rppm merge merges the parts",
        ("cycles.use_sample_subset",),
        lambda scene: bool(of_cycles(scene, "use_sample_subset", False)),
    ),
    Omission(
        "Sampling Pattern",
        "noise has a pattern of RPPM's own",
        ("cycles.sampling_pattern",),
        lambda scene: of_cycles(scene, "sampling_pattern", "AUTOMATIC") not in _OWN_PATTERNS,
    ),
    Omission(
        "Threads",
        "the graphics device renders, and the number of the processor's threads is not limited",
        ("render.threads_mode",),
        lambda scene: scene.render.threads_mode == "FIXED",
    ),
)
"""By what a scene uses."""
