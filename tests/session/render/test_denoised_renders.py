# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders that are denoised: in this process, in the renderer's, and merged of parts."""

import dataclasses
import threading

import numpy as np
import pytest
from session.conftest import run_to_the_end
from support.floor import floor_scene

from rppm_addon.commands.merging import merge_parts
from rppm_addon.denoising.denoiser import Denoiser
from rppm_addon.denoising.places import library_places
from rppm_addon.pictures import read_exr, write_exr
from rppm_addon.scene.passes import NOISY_IMAGE
from rppm_addon.scene.settings import DenoisingInputPasses
from rppm_addon.session.checkpoints.checkpoint_file import write_checkpoint
from rppm_addon.session.checkpoints.checkpoint_writer import still_render
from rppm_addon.session.checkpoints.continuation import Continuation
from rppm_addon.session.client.remote_rendering import RemoteRenderer
from rppm_addon.session.placeholders.known_programs import KnownPrograms
from rppm_addon.session.render.render_job import RenderJob
from rppm_addon.session.render.renderer import Renderer
from rppm_addon.session.transport.arrays import unpack
from rppm_addon.session.transport.sessions import SessionKind
from rppm_addon.session.worker.rendering import Rendering

PLACES = library_places()
needs_library = pytest.mark.skipif(
    not PLACES, reason="there is no Open Image Denoise: install the bpy module (make setup) or pyoidn"
)


@pytest.fixture(scope="module")
def renderer():
    with Renderer() as renderer:
        yield renderer


def floor(denoising=True, iterations=4, **settings):
    """64 x 48 pixels, noisy by few photons in narrow disks, without direct light by rays."""
    scene = floor_scene()
    scene.camera = dataclasses.replace(scene.camera, width=64, height=48)
    scene.settings = scene.settings.with_values(
        iterations=iterations,
        photons=4096,
        direct_light="PHOTONS",
        use_adaptive_radius=False,
        use_denoising=denoising,
        **settings,
    )
    return scene


@needs_library
@pytest.mark.parametrize("inputs", DenoisingInputPasses)
def test_the_noisy_image_is_the_render_without_denoising(renderer, inputs):
    plain = renderer.render(floor(denoising=False, passes=("Depth",))).frame
    result = renderer.render(floor(passes=("Depth",), denoising_input_passes=inputs))
    frame = result.frame
    assert plain.passes.keys() == {"Depth"} and frame.passes.keys() == {"Depth", NOISY_IMAGE.name}
    np.testing.assert_array_equal(frame.passes[NOISY_IMAGE.name], plain.combined)
    np.testing.assert_array_equal(frame.passes["Depth"], plain.passes["Depth"])
    np.testing.assert_array_equal(frame.combined[..., 3], plain.combined[..., 3])
    assert frame.combined.mean() == pytest.approx(plain.combined.mean(), rel=0.01)

    def roughness(picture):
        return np.abs(np.diff(picture[:, 4:28, :3], axis=0)).mean()  # on the floor

    assert roughness(frame.combined) < 0.6 * roughness(plain.combined)
    assert result.statistics.warnings == [] and result.statistics.stage_seconds["denoising"] > 0.0


@needs_library
def test_files_have_both_pictures(renderer, tmp_path):
    frame = renderer.render(floor(denoising_input_passes="RGB")).frame
    write_exr(tmp_path / "floor.exr", frame.combined, frame.passes)
    read = read_exr(tmp_path / "floor.exr")
    np.testing.assert_array_equal(read.combined, frame.combined)
    np.testing.assert_array_equal(read.layer("Noisy Image"), frame.passes["Noisy Image"])
    assert "Noisy Image.A" in read.channels


def test_without_a_library_the_picture_is_noisy_and_a_warning_says_so(renderer):
    plain = renderer.render(floor(denoising=False)).frame
    with Renderer(denoiser=Denoiser([])) as without:
        result = without.render(floor(denoising_input_passes="RGB"))
    np.testing.assert_array_equal(result.frame.combined, plain.combined)
    np.testing.assert_array_equal(result.frame.passes["Noisy Image"], plain.combined)
    (warning,) = result.statistics.warnings
    assert warning.startswith("the picture is not denoised: Open Image Denoise is not there: take a Blender")


@needs_library
def test_a_stopped_render_and_pictures_under_way_are_not_denoised(renderer):
    seen = []
    scene = floor(iterations=8, denoising_input_passes="RGB")
    result = renderer.render(scene, lambda progress, read: seen.append(read()), lambda: len(seen) > 2)
    assert result.stopped and result.statistics.iterations == 2
    np.testing.assert_array_equal(result.frame.combined, seen[-1].combined)
    np.testing.assert_array_equal(result.frame.passes["Noisy Image"], seen[-1].combined)
    assert seen[-1].passes.keys() == set(scene.settings.passes)


@needs_library
def test_snapshots_are_denoised(renderer):
    frames = []
    scene = floor(denoising_input_passes="RGB")
    renderer.render(scene, snapshots=(1e-6,), on_snapshot=lambda seconds, frame: frames.append(frame))
    (frame,) = frames
    assert np.any(frame.combined != frame.passes["Noisy Image"])


@needs_library
def test_parts_are_merged_before_they_are_denoised(renderer, tmp_path):
    whole = renderer.render(floor(denoising_input_passes="RGB")).frame
    parts = []
    for first in (0, 2):
        scene, pauses = floor(iterations=2, denoising_input_passes="RGB"), []
        renderer.render(scene, continuation=Continuation(first, keep=pauses.append))
        parts.append(tmp_path / f"part_{first}.exr")
        write_checkpoint(parts[-1], still_render(scene, {}), pauses[-1], 1.0)
    merged = merge_parts(parts, incomplete=False)
    assert merged.iterations == 4 and merged.warnings == []
    np.testing.assert_allclose(merged.frame.passes["Noisy Image"], whole.passes["Noisy Image"], rtol=1e-5, atol=1e-6)
    np.testing.assert_allclose(merged.frame.combined, whole.combined, rtol=1e-2, atol=1e-3)
    merged.write_exr(tmp_path / "merged.exr")
    read = read_exr(tmp_path / "merged.exr")
    np.testing.assert_array_equal(read.combined, merged.frame.combined)


@needs_library
def test_in_the_renderers_process(renderer, process):
    scene = floor(denoising_input_passes="RGB")
    here = renderer.render(scene).frame
    process.launcher.denoisers = PLACES
    found = RemoteRenderer(process, SessionKind.FINAL).render(scene, RenderJob())
    np.testing.assert_array_equal(found.frame.combined, here.combined)
    np.testing.assert_array_equal(found.frame.passes["Noisy Image"], here.passes["Noisy Image"])
    assert "denoising" in found.statistics.stage_seconds


def test_a_render_in_the_process_is_stopped_while_it_is_denoised(device):
    """And what is denoised then is not waited for."""
    begun, let = threading.Event(), threading.Event()

    class Slow(Denoiser):
        def denoise(self, combined, passes, settings):
            begun.set()
            let.wait(60.0)
            return combined * 0.0

    sent = []
    with device[0].moderngl:
        rendering = Rendering(*device, Slow([]), lambda kind, **content: sent.append((kind, content)), KnownPrograms())
        for stop in (False, True):
            begun.clear(), let.clear(), sent.clear()
            rendering.show(floor(iterations=2, denoising_input_passes="RGB"), 1 + stop, False)
            while not begun.wait(0.0):
                rendering.run_slice()
            rendering.run_slice()
            assert rendering.busy and "result" not in {kind for kind, _ in sent}  # it answers meanwhile
            if stop:
                rendering.stop(2)
            else:
                let.set()
            run_to_the_end(rendering)
            kind, content = sent[-1]
            combined, *_ = unpack(content["arrays"])
            assert (kind, content["stopped"], bool(combined.any())) == ("result", stop, stop)
            rendering.received()
        let.set()
        rendering.release()


def test_a_process_that_knows_no_library_says_so(process):
    found = RemoteRenderer(process, SessionKind.FINAL).render(floor(denoising_input_passes="RGB"), RenderJob())
    assert any("not denoised" in text for text in found.statistics.warnings)
