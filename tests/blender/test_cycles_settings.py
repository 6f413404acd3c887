# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings copied from Cycles and back."""

import bpy

from rppm_addon.blender.panels.cycles_settings import SHARED


def test_from_cycles_and_back(scene):
    cycles, own = scene.cycles, scene.rppm
    cycles.samples, cycles.preview_samples, cycles.time_limit = 300, 40, 12.5
    cycles.seed, cycles.use_animated_seed, cycles.filter_width, cycles.max_bounces = 9, True, 2.0, 5
    cycles.use_denoising, cycles.denoising_quality, cycles.preview_denoising_start_sample = True, "FAST", 7
    assert bpy.ops.rppm.copy_from_cycles() == {"FINISHED"}
    assert [getattr(own, name) for name in list(SHARED)[:7]] == [300, 40, 12.5, 9, True, 2.0, 5]
    assert (own.use_denoising, own.denoising_quality, own.preview_denoising_start_sample) == (True, "FAST", 7)
    assert own.max_photon_bounces == 5
    for name, value in {"samples": 7, "seed": 3, "max_camera_bounces": 2, "use_animated_seed": False}.items():
        setattr(own, name, value)
    cycles.pixel_filter_type = "BOX"
    assert bpy.ops.rppm.copy_to_cycles() == {"FINISHED"}
    assert (cycles.samples, cycles.seed, cycles.max_bounces, cycles.use_animated_seed) == (7, 3, 2, False)
    assert cycles.pixel_filter_type == "BLACKMAN_HARRIS"


def test_what_is_out_of_range_is_brought_into_it(scene):
    scene.cycles.max_bounces, scene.rppm.filter_width = 1024, 0.0
    bpy.ops.rppm.copy_from_cycles()
    assert scene.rppm.max_camera_bounces == 63
    scene.rppm.filter_width = 0.0
    bpy.ops.rppm.copy_to_cycles()
    assert scene.cycles.filter_width > 0.0
