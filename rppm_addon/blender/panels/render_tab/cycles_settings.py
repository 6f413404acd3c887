# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings that RPPM and Cycles both have, copied from one to the other."""

from collections.abc import Iterable

import bpy
from bpy.app.translations import pgettext_iface as iface_

from ...export.omissions import OF_SCENES
from ...export.view_layer.passes import OF_CYCLES
from .. import cycles_properties

SHARED = {
    "samples": "samples",
    "preview_samples": "preview_samples",
    "time_limit": "time_limit",
    "seed": "seed",
    "use_animated_seed": "use_animated_seed",
    "filter_width": "filter_width",
    **{
        name: name
        for name in (
            "max_bounces",
            "transparent_max_bounces",
            "diffuse_bounces",
            "glossy_bounces",
            "transmission_bounces",
            "volume_bounces",
            "sample_clamp_direct",
            "sample_clamp_indirect",
            "caustics_reflective",
            "caustics_refractive",
        )
    },
    **{
        name: name
        for what in ("use_{}denoising", "{}denoising_input_passes", "{}denoising_prefilter", "{}denoising_quality")
        for name in (what.format(""), what.format("preview_"))
    },
    "preview_denoising_start_sample": "preview_denoising_start_sample",
    **{
        name: name
        for what in ("use_{}adaptive_sampling", "{}adaptive_threshold", "{}adaptive_min_samples")
        for name in (what.format(""), what.format("preview_"))
    },
    "use_layer_samples": "use_layer_samples",
    "film_exposure": "film_exposure",
    "pixel_filter_type": "pixel_filter_type",
}
"""RPPM's properties and Cycles' that stand for the same; transparent film is one property for both."""
SHARED_OF_LAYERS = {"use_denoising": "use_denoising", **OF_CYCLES}
"""Cycles' switches of view layers, with the add-on's that stand for the same."""
_LIMITS_OF_PARTS = ("max_camera_bounces", "max_photon_bounces")
_LEAST_AUTOMATIC_THRESHOLD = 0.001


def _clamped(owner: bpy.types.bpy_struct, name: str, value: float) -> float:
    item = owner.bl_rna.properties[name]
    return min(max(value, item.hard_min), item.hard_max) if item.type in {"INT", "FLOAT"} else value


def _copy(source: bpy.types.bpy_struct, target: bpy.types.bpy_struct, names: Iterable[tuple[str, str]]) -> None:
    """Set the target's properties, named second, to the source's, named first, as far as its ranges allow."""
    for name, other in names:
        setattr(target, other, _clamped(target, other, getattr(source, name)))


def _taken_and_left(scene: bpy.types.Scene) -> str:
    """Return a sentence on how many settings Copy from Cycles has taken, and on the features that it has left."""
    number = len(SHARED) + len(SHARED_OF_LAYERS) * len(scene.view_layers)
    left = [iface_(omission.title) for omission in OF_SCENES if omission.is_used(scene)]
    taken = iface_("{} settings of Cycles taken").format(number)
    return f"{taken}; {iface_('not rendered as in Cycles: {}').format(', '.join(left))}" if left else taken


class _CopySettings(bpy.types.Operator):
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, _context: bpy.types.Context) -> bool:
        """Where Cycles is enabled."""
        return cycles_properties.are_there()


class RPPM_OT_copy_from_cycles(_CopySettings):
    """Take samples, noise threshold, denoising, bounces, time limit, seed, exposure, filter and passes from Cycles"""

    bl_idname = "rppm.copy_from_cycles"
    bl_label = "Copy from Cycles"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Copy; the limits that Cycles does not know limit nothing any more."""
        own, cycles = context.scene.rppm, context.scene.cycles
        _copy(cycles, own, ((other, name) for name, other in SHARED.items()))
        for layer in context.scene.view_layers:
            _copy(layer.cycles, layer.rppm, SHARED_OF_LAYERS.items())
        for name in _LIMITS_OF_PARTS:
            own.property_unset(name)
        for prefix in ("", "preview_"):
            if getattr(cycles, f"{prefix}adaptive_threshold") == 0.0:  # automatic, by the samples
                automatic = max(_LEAST_AUTOMATIC_THRESHOLD, 1.0 / max(getattr(cycles, f"{prefix}samples"), 1))
                setattr(own, f"{prefix}adaptive_threshold", automatic)
        self.report({"INFO"}, _taken_and_left(context.scene))
        return {"FINISHED"}


class RPPM_OT_copy_to_cycles(_CopySettings):
    """Give Cycles the samples, noise threshold, denoising, bounces, time limit, seed, exposure, filter and passes"""

    bl_idname = "rppm.copy_to_cycles"
    bl_label = "Copy to Cycles"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Copy."""
        _copy(context.scene.rppm, context.scene.cycles, SHARED.items())
        for layer in context.scene.view_layers:
            _copy(layer.rppm, layer.cycles, ((own, other) for other, own in SHARED_OF_LAYERS.items()))
        return {"FINISHED"}


CLASSES = (RPPM_OT_copy_from_cycles, RPPM_OT_copy_to_cycles)
