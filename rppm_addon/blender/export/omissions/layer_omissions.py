# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of view layers that are otherwise in Cycles, whose switches no other engine reads."""

import bpy

from .omission import of_cycles

_REMEDY = "take all of Cycles' settings with Sampling > Advanced > Copy from Cycles"


def layer_differences(scene: bpy.types.Scene, layer: bpy.types.ViewLayer) -> list[str]:
    """Sentences on what Cycles would do otherwise with a view layer for a setting that both engines have.

    There are none where the extension is not registered, and none on settings that do not count: denoising where the
    scene is not denoised, and Layer Samples where the layer has no samples of its own.
    """
    stored, own = getattr(scene, "rppm", None), getattr(layer, "rppm", None)
    if stored is None or own is None:
        return []
    sentences = []
    if stored.use_denoising and own.use_denoising and not of_cycles(layer, "use_denoising", True):
        sentences.append(
            "Denoising of the view layer is off for Cycles only; switch it off in View Layer > Filter, or " + _REMEDY
        )
    use = of_cycles(scene, "use_layer_samples", stored.use_layer_samples)
    if layer.samples > 0 and use != stored.use_layer_samples:
        sentences.append(
            f"Layer Samples is {_label(scene.cycles, use)} for Cycles and {_label(stored, stored.use_layer_samples)} "
            f"for RPPM; set it in Sampling > Advanced, or {_REMEDY}"
        )
    return sentences


def _label(owner: bpy.types.bpy_struct, value: str) -> str:
    return owner.bl_rna.properties["use_layer_samples"].enum_items[value].name
