# SPDX-License-Identifier: GPL-3.0-or-later
"""bpy.ops.render.render with RPPM: pictures, passes, stopping, errors, animation."""

import logging
from types import SimpleNamespace

import bpy
import numpy as np
import OpenEXR
import pytest
from blender_scenes import set_world
from PIL import Image as Picture

from rppm_addon.blender.engine import final
from rppm_addon.blender.engine import render_engine as engine_module
from rppm_addon.blender.render_client import renderer_thread
from rppm_addon.scene.errors import DeviceError
from rppm_addon.session.checkpoints.checkpoint_file import read_summary
from rppm_addon.session.render import renderer as session_renderer
from rppm_addon.session.render.observers import RenderObserver, observing


def render_exr(scene, folder, **arguments):
    """Layers of the picture: name -> (height, width, channels), row 0 at the bottom."""
    settings = scene.render.image_settings
    if hasattr(settings, "media_type"):
        settings.media_type = "MULTI_LAYER_IMAGE"
    settings.file_format, settings.color_depth = "OPEN_EXR_MULTILAYER", "32"
    scene.render.filepath = str(folder / "picture.exr")
    bpy.ops.render.render(write_still=True, **arguments)
    layers = {}
    with OpenEXR.File(scene.render.filepath, separate_channels=True) as file:
        for part in file.parts:
            for name, channel in part.channels.items():
                layer, letter = name.rsplit(".", 1)
                layers.setdefault(layer, {})[letter] = channel.pixels[::-1]
    return {
        layer: np.stack([channels[letter] for letter in "RGBAXYZ" if letter in channels], axis=-1)
        for layer, channels in layers.items()
    }


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


def test_png(lit, tmp_path):
    lit.render.image_settings.file_format = "PNG"
    lit.render.filepath = str(tmp_path / "picture.png")
    bpy.ops.render.render(write_still=True)
    with Picture.open(lit.render.filepath) as picture:
        pixels = np.asarray(picture.convert("RGB"))
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
    hidden = bpy.data.collections.new("Hidden")
    lit.collection.children.link(hidden)
    quad = bpy.data.objects["Quad"]
    hidden.objects.link(quad)
    lit.collection.objects.unlink(quad)
    second.layer_collection.children["Hidden"].exclude = True
    layers = render_exr(lit, tmp_path)
    assert layers["ViewLayer.Combined"][16, 16, 0] > 0.5
    assert layers["Second.Combined"][16, 16, 0] < 0.01


class Proxy:
    """The engine with some methods replaced; Blender does not let a class replace its own."""

    def __init__(self, engine, replaced):
        self._engine = engine
        self.__dict__.update(replaced)

    def __getattr__(self, name):
        return getattr(self._engine, name)


def replace_methods(monkeypatch, **replaced):
    """Let renders see an engine whose methods of these names are replaced."""
    monkeypatch.setattr(
        engine_module, "render_final", lambda engine, depsgraph: final.render_final(Proxy(engine, replaced), depsgraph)
    )


class Recorder(RenderObserver):
    def __init__(self):
        self.calls, self.errors, self.result, self.progress = [], [], None, []

    def on_scene(self, scene):
        self.calls.append("scene")
        return True

    def on_start(self, scene):
        self.calls.append("start")

    def on_progress(self, progress):
        self.progress.append(progress.iteration)

    def on_finish(self, result, scene):
        self.calls.append("finish")
        self.result = result

    def on_error(self, text):
        self.calls.append("error")
        self.errors.append(text)


def test_the_observer_is_told(lit):
    recorder = Recorder()
    with observing(recorder):
        bpy.ops.render.render()
    assert recorder.calls == ["scene", "start", "finish"] and recorder.progress[-1] == 2
    assert recorder.result.statistics.iterations == 2 and recorder.result.frame.combined.shape == (32, 32, 4)


def test_an_observer_may_want_the_scene_only(lit, monkeypatch):
    monkeypatch.setattr(renderer_thread, "render", lambda *_: pytest.fail("nothing was to be rendered"))

    class SceneOnly(Recorder):
        def on_scene(self, scene):
            self.scene = scene
            return False

    recorder = SceneOnly()
    with observing(recorder):
        bpy.ops.render.render()
    assert recorder.scene.triangle_count == 2 and recorder.errors == []


@pytest.mark.parametrize("iterations", [1, 3])
def test_stopping_between_iterations_keeps_the_picture(lit, tmp_path, monkeypatch, iterations):
    lit.rppm.samples = 1000
    recorder = Recorder()
    replace_methods(monkeypatch, test_break=lambda: bool(recorder.progress) and recorder.progress[-1] >= iterations)
    with observing(recorder):
        combined = render_exr(lit, tmp_path)["ViewLayer.Combined"]
    assert recorder.result.stopped and recorder.result.statistics.iterations == iterations
    assert combined[16, 16, 0] > 0.5


def test_stopping_during_the_export(lit, monkeypatch):
    asked = []

    def test_break():
        asked.append(True)
        return len(asked) >= 2

    replace_methods(monkeypatch, test_break=test_break)
    monkeypatch.setattr(renderer_thread, "render", lambda *_: pytest.fail("the export was to be stopped"))
    recorder = Recorder()
    with observing(recorder):
        bpy.ops.render.render()
    assert len(asked) == 2 and recorder.calls == []


def reported_error(lit):
    """The error that Blender's operator raises with what the engine reported."""
    recorder = Recorder()
    with observing(recorder), pytest.raises(RuntimeError) as raised:
        bpy.ops.render.render()
    (text,) = recorder.errors
    assert text in str(raised.value)
    return text


def test_a_scene_error_is_shown_with_its_remedy(lit):
    lit.camera.data.type = "CUSTOM"
    assert "Perspective, Orthographic or Panoramic" in reported_error(lit)


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
    with monkeypatch.context() as patched:
        patched.setattr(final._FinalJob, "on_frame", lambda *_: 1 / 0)
        with caplog.at_level(logging.CRITICAL + 1):
            assert "ZeroDivisionError" in reported_error(lit)
    recorder = Recorder()
    with observing(recorder):
        bpy.ops.render.render()
    assert recorder.calls == ["scene", "start", "finish"]


def test_warnings_are_reported(lit, monkeypatch):
    reports = []
    replace_methods(monkeypatch, report=lambda kind, text: reports.append((kind, text)))
    lit.camera.scale = (0.0, 0.0, 0.0)
    for index in range(20):
        lit.collection.objects.link(bpy.data.objects.new(f"Smoke{index}", bpy.data.volumes.new("Smoke")))
    bpy.ops.render.render()
    texts = [text for kind, text in reports if kind == {"WARNING"}]
    assert any("it sees the world only" in text for text in texts)
    assert 2 < len(texts) < 12 and texts[-1].startswith("13 more")


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
    shown = []
    lit.rppm.samples = 3
    original = final._FinalJob.on_frame

    def on_frame(self, progress, frame):
        shown.append(progress.iteration)
        original(self, progress, frame)

    monkeypatch.setattr(final._FinalJob, "on_frame", on_frame)
    monkeypatch.setattr(final, "PICTURE_SECONDS", 0.0)
    monkeypatch.setattr(final, "PICTURE_SHARE", 1e9)
    bpy.ops.render.render()
    assert shown == [1, 2]
    shown.clear()
    lit.rppm.samples, lit.rppm.samples_per_frame = 9, 4
    bpy.ops.render.render()
    assert shown == [1, 4, 8]


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
    lit.render.image_settings.file_format = "PNG"
    lit.render.filepath = str(tmp_path / "frame_")
    bpy.ops.render.render(animation=True)
    pictures = []
    for frame in (1, 2):
        with Picture.open(tmp_path / f"frame_{frame:04d}.png") as picture:
            pictures.append(np.asarray(picture.convert("RGB")))
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
