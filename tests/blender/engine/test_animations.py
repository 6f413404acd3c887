# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames of an animation equal those rendered each on its own by a fresh renderer, bit for bit.

So does what a viewport shows while an animation plays.
"""

import bpy
import numpy as np
import pytest
from animations import ANIMATIONS, FRAMES, nothing, stage
from blender_scenes import depsgraph, following
from recorder import record

from rppm_addon.blender.engine import render_engine as engine_module
from rppm_addon.blender.export import SceneSync, export_scene
from rppm_addon.integrator.progressive import ProgressivePhotonMapper
from rppm_addon.scene import Scene
from rppm_addon.session.render.frame_reading import read_frame
from rppm_addon.session.render.results import Frame

ITERATIONS = 3


@pytest.fixture
def animated(scene, tmp_path):
    scene.render.image_settings.file_format = "PNG"
    scene.render.filepath = str(tmp_path / "frame_")
    scene.rppm.samples, scene.rppm.photons, scene.rppm.cubemap_resolution = ITERATIONS, 1024, 64
    scene.rppm.preview_photons = scene.rppm.photons
    scene.rppm.max_camera_bounces = scene.rppm.max_photon_bounces = 3
    stage(scene)
    return scene


def fresh_scene(frame: int, monkeypatch) -> Scene:
    """The scene that a render of one frame exports when nothing is known before."""
    exported = []
    with monkeypatch.context() as patch:
        patch.setattr(engine_module, "render_final", lambda engine, graph: exported.append(export_scene(graph, engine)))
        bpy.context.scene.frame_set(frame)
        bpy.ops.render.render()
    (scene,) = exported
    return scene


def picture(mapper: ProgressivePhotonMapper, scene: Scene) -> Frame:
    """Render a scene that the mapper has just taken."""
    for _ in range(ITERATIONS):
        mapper.iterate()
    return read_frame(mapper.film, scene.exposure)


def fresh_picture(scene: Scene, device) -> Frame:
    """Render a scene with a photon mapper that has rendered nothing before."""
    context, library = device
    with context.moderngl:
        mapper = ProgressivePhotonMapper(context, library)
        mapper.build(scene)
        frame = picture(mapper, scene)
        mapper.release()
    return frame


def assert_same(frame: Frame, alone: Frame, what: str) -> None:
    np.testing.assert_array_equal(frame.combined, alone.combined, what)
    assert list(frame.passes) == list(alone.passes)
    for name, values in frame.passes.items():
        np.testing.assert_array_equal(values, alone.passes[name], f"{name} of {what}")


each_animation = pytest.mark.parametrize("animation", ANIMATIONS, ids=lambda animation: animation.__name__)


@pytest.mark.parametrize(
    ("animation", "persistent"),
    [
        pytest.param(
            animation, persistent, id=f"{animation.__name__}-{persistent}",
            marks=[] if persistent or animation.__name__ in ("materials", "spotlight") else [pytest.mark.long],
        )
        for animation in ANIMATIONS
        for persistent in (False, True)
    ],
)  # fmt: skip
def test_frames_are_those_rendered_alone(animated, animation, persistent, device, tmp_path, monkeypatch):
    animation(animated, tmp_path)
    animated.render.use_persistent_data = persistent
    seen = record(animation=True)
    assert len(seen.frames) == len(FRAMES)
    for number, frame in zip(FRAMES, seen.frames, strict=True):
        assert_same(frame, fresh_picture(fresh_scene(number, monkeypatch), device), f"frame {number}")
    moves = [a.combined.shape != b.combined.shape or (a.combined != b.combined).any()
             for a, b in zip(seen.frames, seen.frames[1:])]  # fmt: skip
    assert all(moves) if animation.__name__ != "nothing" else not any(moves)


SHARES = (50, 100, 75, 25)
"""Resolution of FRAMES in percent."""


def resize(scene: bpy.types.Scene, _: object) -> None:
    scene.render.resolution_percentage = SHARES[scene.frame_current - FRAMES[0]]


def test_renders_of_other_sizes_are_those_of_fresh_renderers(animated, device, tmp_path, monkeypatch):
    """Blender has no keyframes for the resolution: a script changes it between renders."""
    nothing(animated, tmp_path)
    bpy.app.handlers.frame_change_pre.append(resize)  # loading a file removes it
    frames = []
    for number in FRAMES:
        animated.frame_set(number)
        frames += record().frames
    assert [frame.combined.shape[:2] for frame in frames] == [(32 * share // 100,) * 2 for share in SHARES]
    for number, frame in zip(FRAMES, frames, strict=True):
        assert_same(frame, fresh_picture(fresh_scene(number, monkeypatch), device), f"frame {number}")


def test_an_animation_cannot_change_its_size(animated):
    """Blender lays out all its frames as large as the first one."""
    bpy.app.handlers.frame_change_pre.append(resize)
    seen = record(animation=True)
    assert [frame.combined.shape[:2] for frame in seen.frames] == [(32, 32)]
    assert len(seen.errors) == len(FRAMES) - 1 and all("one at a time" in text for text in seen.errors)


@each_animation
def test_playback_shows_what_a_fresh_viewport_does(animated, animation, device, tmp_path):
    animation(animated, tmp_path)
    sync, camera = SceneSync(), export_scene(depsgraph()).camera
    context, library = device
    with context.moderngl:
        mapper = ProgressivePhotonMapper(context, library)
    with following(lambda graph: sync.update(graph, camera)):
        for number in (*FRAMES, 2, 1):
            animated.frame_set(number)
            fresh = SceneSync().update(depsgraph(), camera)
            with context.moderngl:
                mapper.update(sync.scene)
                frame = picture(mapper, sync.scene)
            assert_same(frame, fresh_picture(fresh, device), f"frame {number}")
    with context.moderngl:
        mapper.release()
