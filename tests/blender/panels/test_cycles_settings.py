# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings copied from Cycles and back."""

import bpy

from rppm_addon.blender.export.view_layer.passes import OF_CYCLES
from rppm_addon.blender.panels.render_tab.cycles_settings import SHARED


def test_from_cycles_and_back(scene):
    cycles, own = scene.cycles, scene.rppm
    cycles.samples, cycles.preview_samples, cycles.time_limit = 300, 40, 12.5
    cycles.seed, cycles.use_animated_seed, cycles.filter_width, cycles.max_bounces = 9, True, 2.0, 5
    cycles.diffuse_bounces, cycles.glossy_bounces, cycles.transmission_bounces = 4, 3, 12
    cycles.transparent_max_bounces, own.max_camera_bounces, own.max_photon_bounces = 20, 3, 3
    cycles.volume_bounces = 2
    cycles.use_denoising, cycles.denoising_quality, cycles.preview_denoising_start_sample = True, "FAST", 7
    assert bpy.ops.rppm.copy_from_cycles() == {"FINISHED"}
    assert [getattr(own, name) for name in list(SHARED)[:12]] == [300, 40, 12.5, 9, True, 2.0, 5, 20, 4, 3, 12, 2]
    assert (own.use_denoising, own.denoising_quality, own.preview_denoising_start_sample) == (True, "FAST", 7)
    assert own.max_camera_bounces == own.max_photon_bounces == 1024, "total bounces mean what they mean in Cycles"
    for name, value in {"samples": 7, "seed": 3, "max_bounces": 2, "use_animated_seed": False}.items():
        setattr(own, name, value)
    own.pixel_filter_type, own.film_exposure, own.use_preview_adaptive_sampling = "BOX", 2.0, False
    assert bpy.ops.rppm.copy_to_cycles() == {"FINISHED"}
    assert (cycles.samples, cycles.seed, cycles.max_bounces, cycles.use_animated_seed) == (7, 3, 2, False)
    assert (cycles.pixel_filter_type, cycles.film_exposure) == ("BOX", 2.0)
    assert not cycles.use_preview_adaptive_sampling


def test_an_automatic_noise_threshold_is_that_of_cycles(scene):
    cycles, own = scene.cycles, scene.rppm
    cycles.use_adaptive_sampling, cycles.adaptive_threshold, cycles.samples = True, 0.0, 200
    cycles.preview_adaptive_threshold, cycles.preview_adaptive_min_samples = 0.2, 9
    cycles.pixel_filter_type, cycles.film_exposure = "GAUSSIAN", 0.5
    bpy.ops.rppm.copy_from_cycles()
    assert own.use_adaptive_sampling and abs(own.adaptive_threshold - 0.005) < 1e-6
    assert abs(own.preview_adaptive_threshold - 0.2) < 1e-6 and own.preview_adaptive_min_samples == 9
    assert (own.pixel_filter_type, own.film_exposure) == ("GAUSSIAN", 0.5)


def test_what_is_out_of_range_is_brought_into_it(scene):
    scene.cycles.max_bounces, scene.rppm.filter_width = 1024, 0.0
    bpy.ops.rppm.copy_from_cycles()
    assert scene.rppm.max_bounces == 1024
    scene.rppm.filter_width = 0.0
    bpy.ops.rppm.copy_to_cycles()
    assert scene.cycles.filter_width > 0.0


def test_passes_of_all_view_layers(scene):
    """Passes for which Cycles has switches of its own are copied both ways."""
    other = scene.view_layers.new("Other")
    other.cycles.denoising_store_passes = other.cycles.pass_debug_sample_count = True
    other.cycles.use_pass_volume_indirect = True
    bpy.ops.rppm.copy_from_cycles()
    assert [getattr(other.rppm, name) for name in OF_CYCLES.values()] == [True, False, True, False, True]
    assert not any(getattr(scene.view_layers[0].rppm, name) for name in OF_CYCLES.values())
    other.rppm.use_pass_denoising_data, other.rppm.use_pass_shadow_catcher = False, True
    other.rppm.use_pass_volume_direct = True
    bpy.ops.rppm.copy_to_cycles()
    assert [getattr(other.cycles, name) for name in OF_CYCLES] == [False, True, True, True, True]


def test_denoising_and_samples_of_view_layers(scene):
    other = scene.view_layers.new("Other")
    other.cycles.use_denoising, scene.cycles.use_layer_samples = False, "BOUNDED"
    bpy.ops.rppm.copy_from_cycles()
    assert [layer.rppm.use_denoising for layer in scene.view_layers] == [True, False]
    assert scene.rppm.use_layer_samples == "BOUNDED"
    other.rppm.use_denoising, scene.rppm.use_layer_samples = True, "IGNORE"
    bpy.ops.rppm.copy_to_cycles()
    assert other.cycles.use_denoising and scene.cycles.use_layer_samples == "IGNORE"


def test_settings_of_light_paths(scene):
    cycles, own = scene.cycles, scene.rppm
    cycles.sample_clamp_direct, cycles.sample_clamp_indirect = 2.0, 10.0
    cycles.caustics_reflective, cycles.caustics_refractive = False, True
    bpy.ops.rppm.copy_from_cycles()
    assert (own.sample_clamp_direct, own.sample_clamp_indirect) == (2.0, 10.0)
    assert not own.caustics_reflective and own.caustics_refractive
    own.caustics_reflective, own.sample_clamp_direct = True, 0.0
    bpy.ops.rppm.copy_to_cycles()
    assert cycles.caustics_reflective and cycles.sample_clamp_direct == 0.0


def test_copying_says_what_it_has_taken_and_left(scene, capfd):
    bpy.ops.rppm.copy_from_cycles()
    assert "settings of Cycles taken" in (plain := capfd.readouterr().out) and "not rendered" not in plain
    scene.cycles.use_fast_gi = scene.cycles.use_sample_subset = True
    bpy.ops.rppm.copy_from_cycles()
    assert "taken; not rendered as in Cycles: Fast GI Approximation, Sample Subset" in capfd.readouterr().out
