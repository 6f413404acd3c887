# SPDX-License-Identifier: GPL-3.0-or-later
"""Features and settings of scenes that RPPM does not render by, or not as Cycles does."""

from collections.abc import Callable

import bpy

from ..geometry.meshes.dicing import adaptive_modifier
from .omission import Omission, of_cycles

_OWN_PATTERNS = {"AUTOMATIC", "TABULATED_SOBOL"}
"""Sampling patterns that users need not have chosen: Cycles' own choice, and what it gives older files."""


def _has_transparent_glass_of_cycles_only(scene: bpy.types.Scene) -> bool:
    own = getattr(getattr(scene, "rppm", None), "film_transparent_glass", False)
    return scene.render.film_transparent and bool(of_cycles(scene, "film_transparent_glass", False)) and not own


def _is_diced_by(name: str, default: object) -> Callable[[bpy.types.Scene], bool]:
    """Return a condition: a scene has another value of a setting of dicing than Cycles' default, and what to dice."""

    def is_used(scene: bpy.types.Scene) -> bool:
        is_set = of_cycles(scene, name, default) != default
        return is_set and any(adaptive_modifier(source) is not None for source in scene.objects)

    return is_used


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
    Omission(
        "Dicing Camera",
        "objects are divided as the scene's camera sees them",
        ("cycles.dicing_camera",),
        _is_diced_by("dicing_camera", None),
    ),
    Omission(
        "Max Subdivisions",
        "dicing rates and a million triangles of a mesh alone limit how finely objects are divided",
        ("cycles.max_subdivisions",),
        _is_diced_by("max_subdivisions", 12),
    ),
    Omission(
        "Offscreen Scale",
        "objects outside of the picture are divided like those in it",
        ("cycles.offscreen_dicing_scale",),
        _is_diced_by("offscreen_dicing_scale", 4.0),
    ),
)
"""By what a scene uses."""
