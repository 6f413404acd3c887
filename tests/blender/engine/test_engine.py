# SPDX-License-Identifier: GPL-3.0-or-later
"""bpy.ops.render.render with RPPM: pictures, passes, stopping, errors, animation."""

import logging
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from blender_scenes import collect, set_world
from engine_calls import replace_methods
from exr import render_exr
from PIL import Image as Picture
from recorder import Recorder, record

from rppm_addon.blender.engine import final
from rppm_addon.blender.render_client import renderer_thread
from rppm_addon.scene.errors import DeviceError
from rppm_addon.session.checkpoints.checkpoint_file import read_summary
from rppm_addon.session.render import renderer as session_renderer


def read_png(path):
    with Picture.open(path) as picture:
        return np.asarray(picture.convert("RGB"))


def test_picture_and_passes(lit, tmp_path):
    layer = lit.view_layers[0]
    layer.use_pass_z = layer.use_pass_normal = True
    layers = render_exr(lit, tmp_path)
    assert set(layers) == {"ViewLayer.Combined", "ViewLayer.Depth", "ViewLayer.Normal"}
    combined, depth, normal = (layers[f"ViewLayer.{name}"] for name in ("Combined", "Depth", "Normal"))
    assert combined.shape == (32, 32, 4) and depth.shape == (32, 32, 1) and normal.shape == (32, 32, 3)
    # Diffuse white under irradiance pi.
    np.testing.assert_allclose(combined[16, 16], (1.0, 1.0, 1.0, 1.0), rtol=1e-3)
    np.testing.assert_allclose(combined[2, 2], (0.0, 0.0, 0.0, 1.0), atol=1e-6)
    np.testing.assert_allclose(depth[16, 16], 5.0, rtol=1e-3)
    assert depth[2, 2] == pytest.approx(1e10)
    np.testing.assert_allclose(normal[16, 16], (0.0, 0.0, 1.0), atol=1e-3)
    np.testing.assert_allclose(normal[2, 2], 0.0, atol=1e-6)


def test_a_checkpoint_keeps_a_final_render(lit, tmp_path, caplog):
    """More samples go on with it; for the frame's number and the view layer it has names of its own."""
    lit.rppm.samples, lit.rppm.checkpoint_path = 2, str(tmp_path / "kept_##.exr")
    render_exr(lit, tmp_path)
    assert (tmp_path / "kept_01.exr").is_file()
    lit.rppm.samples = 5
    kept = render_exr(lit, tmp_path)["ViewLayer.Combined"]
    assert read_summary(tmp_path / "kept_01.exr").iteration == 5
    lit.rppm.checkpoint_path = ""
    np.testing.assert_array_equal(kept, render_exr(lit, tmp_path)["ViewLayer.Combined"])
    engine = SimpleNamespace(is_preview=False, is_animation=True)
    depsgraph = SimpleNamespace(scene=lit, view_layer_eval=lit.view_layers[0])
    lit.rppm.checkpoint_path = str(tmp_path / "still.exr")
    assert final.checkpoint_of(engine, depsgraph) is None
    engine.is_animation = False
    assert final.checkpoint_of(engine, depsgraph) == tmp_path / "still.exr"
    lit.view_layers.new("Other/layer")
    depsgraph.view_layer_eval = lit.view_layers[1]
    assert final.checkpoint_of(engine, depsgraph) == tmp_path / "still_Other_layer.exr"
    engine.is_preview = True
    assert final.checkpoint_of(engine, depsgraph) is None


def test_only_the_passes_asked_for(lit, tmp_path):
    layer = lit.view_layers[0]
    layer.use_pass_z = layer.use_pass_normal = False
    assert set(render_exr(lit, tmp_path)) == {"ViewLayer.Combined"}


def test_the_deep_cubemap_pass(lit, tmp_path):
    """Steps, triangle tests and listed triangles of the ray through each pixel."""
    lit.view_layers[0].rppm.use_pass_deep_cubemap = True
    costs = render_exr(lit, tmp_path)["ViewLayer.Deep Cubemap"]
    assert costs.shape == (32, 32, 3) and np.all(costs >= 0) and np.all(costs == np.floor(costs))
    assert np.all(costs[16, 16] >= 1)  # sees the surface
    assert costs[2, 2, 2] == 0  # sees nothing


def write_png(scene, path):
    scene.render.image_settings.file_format, scene.render.filepath = "PNG", str(path)


def test_png(lit, tmp_path):
    write_png(lit, tmp_path / "picture.png")
    bpy.ops.render.render(write_still=True)
    pixels = read_png(lit.render.filepath)
    assert pixels.shape == (32, 32, 3) and pixels[16, 16].min() > 150 and pixels[2, 2, 0] < 5


def test_transparent_film(lit, tmp_path):
    lit.render.film_transparent = True
    combined = render_exr(lit, tmp_path)["ViewLayer.Combined"]
    assert combined[16, 16, 3] == 1.0 and not combined[2, 2].any()


@pytest.mark.parametrize("cropped", [False, True])
def test_border(lit, tmp_path, cropped):
    whole = render_exr(lit, tmp_path)["ViewLayer.Combined"]
    render = lit.render
    render.use_border, render.use_crop_to_border = True, cropped
    render.border_min_x, render.border_max_x = 0.5, 1.0
    render.border_min_y, render.border_max_y = 0.25, 0.75
    combined = render_exr(lit, tmp_path)["ViewLayer.Combined"]
    if cropped:
        assert combined.shape == (16, 16, 4)
        inside = combined
    else:
        assert combined.shape == (32, 32, 4)
        inside = combined[8:24, 16:]
        assert not combined[:8].any() and not combined[:, :16].any()
    # The same picture as in the whole frame: lit where the quad is, black elsewhere.
    np.testing.assert_array_equal(inside[..., 0] > 0.5, whole[8:24, 16:, 0] > 0.5)


def test_every_view_layer_is_rendered(lit, tmp_path):
    second = lit.view_layers.new("Second")
    lit.collection.children.link(collect(lit, bpy.data.objects["Quad"], name="Hidden"))
    second.layer_collection.children["Hidden"].exclude = True
    layers = render_exr(lit, tmp_path)
    assert layers["ViewLayer.Combined"][16, 16, 0] > 0.5
    assert layers["Second.Combined"][16, 16, 0] < 0.01


def test_the_observer_is_told(lit):
    recorder = record()
    assert recorder.calls == ["scene", "start", "finish"] and recorder.iterations[-1] == 2


def test_an_observer_may_want_the_scene_only(lit, monkeypatch):
    monkeypatch.setattr(renderer_thread, "render", lambda *_: pytest.fail("nothing was to be rendered"))
    recorder = record(Recorder(renders=False))
    assert recorder.scenes[0].triangle_count == 2 and recorder.errors == []


@pytest.mark.parametrize("iterations", [1, 3])
def test_stopping_between_iterations_keeps_the_picture(lit, tmp_path, monkeypatch, iterations):
    lit.rppm.samples = 1000
    recorder = Recorder()
    replace_methods(monkeypatch, test_break=lambda: bool(recorder.iterations) and recorder.iterations[-1] >= iterations)
    combined = render_exr(lit, tmp_path, observer=recorder)["ViewLayer.Combined"]
    assert recorder.result.stopped and recorder.result.statistics.iterations == iterations
    assert combined[16, 16, 0] > 0.5


def test_stopping_during_the_export(lit, monkeypatch):
    asked = []

    def test_break():
        asked.append(True)
        return len(asked) >= 2

    replace_methods(monkeypatch, test_break=test_break)
    monkeypatch.setattr(renderer_thread, "render", lambda *_: pytest.fail("the export was to be stopped"))
    assert record().calls == [] and len(asked) == 2


def reported_error(lit):
    """The error that Blender's operator raises with what the engine reported."""
    recorder = Recorder()
    with pytest.raises(RuntimeError) as raised:
        record(recorder)
    (text,) = recorder.errors
    assert text in str(raised.value)
    return text


def test_a_scene_error_is_shown_with_its_remedy(lit):
    lit.camera.location.x = float("nan")
    assert "is not finite; correct its transform" in reported_error(lit)


def test_no_camera_is_an_error(lit):
    lit.camera = None
    with pytest.raises(RuntimeError, match="camera"):
        bpy.ops.render.render()


def test_a_device_error_is_shown(lit, monkeypatch):
    def fail(self, *_):
        raise DeviceError("no OpenGL 4.3 here; install a driver")

    renderer_thread.release()
    monkeypatch.setattr(session_renderer.Renderer, "__init__", fail)
    assert reported_error(lit) == "no OpenGL 4.3 here; install a driver"


def test_a_defect_is_shown_and_the_next_render_works(lit, monkeypatch, caplog):
    with monkeypatch.context() as patched, caplog.at_level(logging.CRITICAL + 1):
        replace_methods(patched, update_result=lambda _: 1 / 0)
        assert "ZeroDivisionError" in reported_error(lit)
    assert record().calls == ["scene", "start", "finish"]


def test_warnings_are_reported(lit, monkeypatch):
    reports = []
    replace_methods(monkeypatch, report=lambda kind, text: reports.append((kind, text)))
    lit.camera.scale = (0.0, 0.0, 0.0)
    for index in range(20):
        smoke = bpy.data.volumes.new("Smoke")
        smoke.filepath = "//missing.vdb"
        lit.collection.objects.link(bpy.data.objects.new(f"Smoke{index}", smoke))
    bpy.ops.render.render()
    texts = [text for kind, text in reports if kind == {"WARNING"}]
    assert len(texts) == 2 and any("it sees the world only" in text for text in texts)
    assert any(text.startswith("Missing.vdb: missing.vdb not found (") and "17 more" in text for text in texts)


def test_progress_and_status(lit, monkeypatch):
    stats, progress = [], []
    replace_methods(monkeypatch, update_stats=lambda _, info: stats.append(info), update_progress=progress.append)
    lit.rppm.samples = 4
    bpy.ops.render.render()
    assert any(text.startswith("Exporting") for text in stats)
    lines = [text.split(" | ") for text in stats if "Sample" in text]
    assert [line[-2] for line in lines] == [f"Sample {iteration}/4" for iteration in range(5)]
    assert all(line[-4].startswith("Mem:") and line[-3] == "Scene, ViewLayer" for line in lines)
    assert [line[0].split(":")[0] for line in lines] == ["Mem", *["Remaining"] * 4]
    assert progress == sorted(progress) and progress[-1] == 1.0


def test_the_first_picture_comes_after_the_first_iteration(lit, monkeypatch):
    lit.rppm.samples, recorder, shown = 3, Recorder(), []
    replace_methods(monkeypatch, update_result=lambda _: shown.append(recorder.iterations[-1]))
    monkeypatch.setattr(final, "PICTURE_SECONDS", 0.0)
    monkeypatch.setattr(final, "PICTURE_SHARE", 1e9)
    record(recorder)
    assert shown == [1, 2, 3]  # the last one at the end
    shown.clear()
    lit.rppm.samples, lit.rppm.samples_per_frame = 9, 4
    record(recorder)
    assert shown == [1, 4, 8, 9]


def test_animation_keeps_the_renderer(lit, tmp_path, monkeypatch):
    made = []
    original = session_renderer.Renderer.__init__

    def count(self, device=None, denoiser=None, times_stages=False):
        made.append(True)
        original(self, device, denoiser, times_stages)

    renderer_thread.release()
    monkeypatch.setattr(session_renderer.Renderer, "__init__", count)
    quad = bpy.data.objects["Quad"]
    quad.keyframe_insert("location", frame=1)
    quad.location.x = 100.0
    quad.keyframe_insert("location", frame=2)
    lit.frame_start, lit.frame_end = 1, 2
    write_png(lit, tmp_path / "frame_")
    bpy.ops.render.render(animation=True)
    pictures = [read_png(tmp_path / f"frame_{frame:04d}.png") for frame in (1, 2)]
    assert pictures[0][16, 16, 0] > 150 and pictures[1][16, 16, 0] < 5
    assert made == [True]


def test_an_empty_scene_shows_its_world(scene, tmp_path):
    set_world(scene, (0.5, 0.25, 0.125))
    scene.rppm.samples, scene.rppm.photons = 1, 64
    combined = render_exr(scene, tmp_path)["ViewLayer.Combined"]
    np.testing.assert_allclose(combined[..., :3].mean(axis=(0, 1)), (0.5, 0.25, 0.125), rtol=1e-3)


def test_one_pixel(lit, tmp_path):
    lit.render.resolution_x = lit.render.resolution_y = 4
    lit.render.resolution_percentage = 25
    lit.camera.data.ortho_scale = 0.5
    combined = render_exr(lit, tmp_path)["ViewLayer.Combined"]
    assert combined.shape == (1, 1, 4) and combined[0, 0, 0] == pytest.approx(1.0, rel=0.1)
