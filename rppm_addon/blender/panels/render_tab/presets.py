# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets of the photon mapper's settings: those in ../presets/rppm, and the user's own."""

from pathlib import Path

import bpy
from bl_operators.presets import AddPresetBase
from bl_ui.utils import PresetPanel

FOLDER = Path(__file__).resolve().parents[2]
"""Holds ``presets/rppm``, where Blender looks for the presets that come with the extension."""
SETTINGS = (
    "samples",
    "photons",
    "direct_light",
    "use_final_gather",
    "max_bounces",
    "transparent_max_bounces",
    "max_camera_bounces",
    "max_photon_bounces",
    "radius_scale",
    "alpha",
)
"""Settings in a preset: those that trade time for quality. Limits in meters, seeds and the like belong to a scene."""


class RPPM_PT_presets(PresetPanel, bpy.types.Panel):
    bl_label = "Photon Mapping Presets"
    preset_subdir = "rppm"
    preset_operator = "script.execute_preset"
    preset_add_operator = "rppm.preset_add"


class RPPM_OT_preset_add(AddPresetBase, bpy.types.Operator):
    """Add or remove a preset of the photon mapper's settings"""

    bl_idname = "rppm.preset_add"
    bl_label = "Add Photon Mapping Preset"
    preset_menu = "RPPM_PT_presets"
    preset_defines = ("settings = bpy.context.scene.rppm",)
    preset_values = tuple(f"settings.{name}" for name in SETTINGS)
    preset_subdir = "rppm"


CLASSES = (RPPM_PT_presets, RPPM_OT_preset_add)


def register() -> None:
    """Let Blender find the presets that come with the extension."""
    bpy.utils.register_preset_path(str(FOLDER))


def unregister() -> None:
    """Take out the menu of presets."""
    bpy.utils.unregister_preset_path(str(FOLDER))
