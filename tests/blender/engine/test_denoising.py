# SPDX-License-Identifier: GPL-3.0-or-later
"""Denoising in Blender: the pass, the panels, the preferences, and the library that Blender ships."""

import bpy
import numpy as np
import pytest
from drawing import context_of, drawn, preferences_context
from exr import render_exr

from rppm_addon.blender import preferences
from rppm_addon.blender.panels.render_tab import sampling
from rppm_addon.blender.render_client import denoising_libraries as libraries_module
from rppm_addon.blender.render_client import renderer_process, renderer_thread
from rppm_addon.blender.render_client.denoising_libraries import denoising_libraries
from rppm_addon.denoising.places import Source
from rppm_addon.session.client.client import ProcessState

PANELS = (sampling.RPPM_PT_sampling_viewport_denoise, sampling.RPPM_PT_sampling_final_denoise)


@pytest.fixture
def without_libraries(monkeypatch):
    monkeypatch.setattr(libraries_module, "library_places", lambda *_: [])
    renderer_thread.release()
    yield
    renderer_thread.release()


def noisy_scene(lit):
    lit.rppm.direct_light, lit.rppm.samples = "PHOTONS", 3
    lit.rppm.use_denoising, lit.rppm.denoising_input_passes = True, "RGB"
    return lit


def test_blender_ships_the_library():
    (library, *_) = denoising_libraries()
    assert library.source is Source.BLENDER and library.path.parent.name == "lib" and "bpy" in library.path.parts


def test_a_final_render_has_both_pictures(lit, tmp_path):
    scene = noisy_scene(lit)
    scene.rppm.use_denoising = False
    plain = render_exr(scene, tmp_path)
    scene.rppm.use_denoising = True
    layers = render_exr(scene, tmp_path)
    assert set(layers) - set(plain) == {"ViewLayer.Noisy Image"}
    combined, noisy = layers["ViewLayer.Combined"], layers["ViewLayer.Noisy Image"]
    np.testing.assert_array_equal(noisy, plain["ViewLayer.Combined"])
    assert np.any(combined != noisy) and combined.mean() == pytest.approx(noisy.mean(), rel=0.02)


def test_a_layer_that_is_not_denoised_has_one_picture(lit, tmp_path):
    scene = noisy_scene(lit)
    denoised = render_exr(scene, tmp_path)
    scene.view_layers[0].rppm.use_denoising = False
    plain = render_exr(scene, tmp_path)
    assert set(denoised) - set(plain) == {"ViewLayer.Noisy Image"}
    np.testing.assert_array_equal(plain["ViewLayer.Combined"], denoised["ViewLayer.Noisy Image"])


def test_without_a_library_it_renders_and_warns(lit, tmp_path, without_libraries, monkeypatch):
    said = []
    monkeypatch.setattr("rppm_addon.blender.engine.final.report_warnings", lambda engine, texts: said.extend(texts))
    layers = render_exr(noisy_scene(lit), tmp_path)
    np.testing.assert_array_equal(layers["ViewLayer.Combined"], layers["ViewLayer.Noisy Image"])
    assert any("the picture is not denoised" in text and "pyoidn" in text for text in said)


def test_the_panels(scene, without_libraries):
    for panel, prefix in zip(PANELS, ("preview_", "")):
        record = drawn(panel, context_of(scene))
        names = ["input_passes", "prefilter", "quality", "use_gpu", *(["start_sample"] if prefix else [])]
        assert record.properties == [f"use_{prefix}denoising", *(f"{prefix}denoising_{name}" for name in names)]
        assert "Open Image Denoise is not there" in " ".join(record.labels)


def test_the_panels_say_nothing_where_there_is_a_library(scene):
    for panel in PANELS:
        assert drawn(panel, context_of(scene)).labels == []


def test_the_compositor_has_a_socket_as_soon_as_it_is_on(scene):
    def names():
        node = scene.compositing_node_group.nodes[0]
        return {socket.name for socket in node.outputs if socket.enabled and not socket.is_unavailable}

    scene.compositing_node_group = bpy.data.node_groups.new("Compositing", "CompositorNodeTree")
    scene.compositing_node_group.nodes.new("CompositorNodeRLayers").scene = scene
    assert "Noisy Image" not in names()
    scene.rppm.use_denoising = True
    assert "Noisy Image" in names()
    scene.rppm.use_denoising = False
    assert "Noisy Image" not in names()


def test_the_preferences_say_which_library_is_used(process, monkeypatch):
    record = drawn(preferences.RppmPreferences, preferences_context())
    assert f"of Blender: {denoising_libraries()[0].path}" in record.labels
    monkeypatch.setattr(libraries_module, "library_places", lambda *_: [])
    record = drawn(preferences.RppmPreferences, preferences_context())
    assert "Open Image Denoise is not there" in " ".join(record.labels) and "denoiser_path" in record.properties


def test_another_library_starts_a_process_that_runs_anew(process):
    process.launcher.denoisers, process.state = [], ProcessState.RUNNING
    renderer_process.libraries_changed()
    assert process.launcher.denoisers == denoising_libraries() and process.restarted == 1
    process.state = ProcessState.STOPPED
    renderer_process.libraries_changed()
    assert process.restarted == 1
