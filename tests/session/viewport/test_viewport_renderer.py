# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures that a viewport shows before the renderer's first frame."""

import copy
import dataclasses

import numpy as np
import pytest
from session.conftest import run_to_the_end, with_settings
from session.frame_receiver import FrameReceiver
from support.floor import floor_scene

from rppm_addon.denoising.denoiser import Denoiser
from rppm_addon.gl.context.context import Context
from rppm_addon.gl.programs.programs import ProgramLibrary
from rppm_addon.integrator.common.stage_sizes import StageSizes
from rppm_addon.integrator.viewport.pictures import expected_bytes
from rppm_addon.scene import Panorama, PanoramaKind
from rppm_addon.scene.meshes import Dicing
from rppm_addon.session.placeholders.known_programs import MOST_TRIANGLES, KnownPrograms
from rppm_addon.session.viewport.viewport_renderer import ViewportRenderer


@pytest.fixture
def known_programs():
    return KnownPrograms()


@pytest.fixture
def open_viewport(known_programs):
    """A function that opens viewports of one process; they share what is compiled."""
    library, opened = ProgramLibrary(context := Context.create()), []

    def open_viewport(scene=None):
        """A viewport, at its end with a scene if one is given, and what it sends."""
        sent = FrameReceiver()
        opened.append(ViewportRenderer(context, library, Denoiser([]), sent, known_programs))
        if scene is not None:
            opened[-1].show(scene, 1, False)
            run_to_the_end(opened[-1])
        return opened[-1], sent

    yield open_viewport
    for viewport in opened:
        viewport.release()
    library.release()
    context.release()


def scene_of(**changes):
    return dataclasses.replace(with_settings(floor_scene(), iterations=2), **changes)


def compiled(sent):
    """Fractions of the programs that were compiled, by the statuses before the first iteration."""
    return [status["compilation"]["fraction"] for status in sent.statuses if status["progress"] is None]


def test_a_first_look_comes_before_anything_is_compiled(open_viewport):
    viewport, sent = open_viewport()
    viewport.show(scene_of(), 1, False)
    viewport.run_slice()
    assert sent.shown == [(1, 0.0)]
    assert not sent.statuses  # which say what is compiled
    look = sent.picture
    # The floor covers the left half.
    assert (look[:, :8, :3] > 0.1).all() and not look[:, 8:, :3].any()
    run_to_the_end(viewport)
    assert sent.shown[-1] == (1, 1.0) and sorted(sent.shown) == sent.shown
    assert [progress for _, progress in sent.shown].count(0.0) == 1
    assert compiled(sent) == sorted(compiled(sent)) and 0.0 < compiled(sent)[-1] < 1.0


def test_there_is_none_once_there_was_a_frame(open_viewport):
    viewport, sent = open_viewport(scene_of())
    seen = len(sent.frames)
    viewport.show(scene_of(exposure=0.5), 2, False)
    run_to_the_end(viewport)
    assert 0.0 not in [progress for _, progress in sent.shown[seen:]] and sent.shown[-1] == (2, 1.0)


def test_there_is_none_when_the_programs_are_ready(open_viewport):
    for expected in (1, 0):
        viewport, sent = open_viewport(scene_of())
        assert [progress for _, progress in sent.shown].count(0.0) == expected


def test_large_scenes_and_new_materials_have_one_in_any_case(open_viewport, known_programs):
    viewport, _ = open_viewport(scene_of())
    scene = scene_of()
    assert known_programs.cover(scene)
    glossy = dataclasses.replace(scene.materials[0], graph=dataclasses.replace(scene.materials[0].graph))
    glossy.graph.nodes = [dataclasses.replace(node, kind="bsdf_glossy") for node in glossy.graph.nodes]
    assert not known_programs.cover(dataclasses.replace(scene, materials=[glossy]))
    raised = dataclasses.replace(scene.materials[0], graph=copy.deepcopy(scene.materials[0].graph))
    raised.graph.displacement = raised.graph.add("displacement", "displacement", height=0.5)
    displaced = scene_of(materials=[raised])
    assert not known_programs.cover(displaced)
    open_viewport(displaced)
    assert known_programs.cover(displaced)
    divided = dataclasses.replace(scene.meshes[0], dicing=Dicing(1.0, True, False))
    assert not known_programs.cover(scene_of(meshes=[divided]))
    assert not known_programs.cover(dataclasses.replace(displaced, meshes=[divided]))
    many = MOST_TRIANGLES // scene.meshes[0].triangle_count + 1
    assert not known_programs.cover(dataclasses.replace(scene, instances=scene.instances * many))


def test_panoramas_have_none(open_viewport):
    panorama = Panorama(PanoramaKind.EQUIRECTANGULAR)
    camera = dataclasses.replace(scene_of().camera, panorama=panorama, window=(0.0, 1.0, 0.0, 1.0))
    _, sent = open_viewport(scene_of(camera=camera))
    assert 0.0 not in [progress for _, progress in sent.shown] and sent.shown[-1] == (1, 1.0)


def test_it_follows_the_view_while_programs_are_compiled(open_viewport):
    viewport, sent = open_viewport()
    scene = scene_of()
    viewport.show(scene, 1, False)
    viewport.run_slice()
    moved = dataclasses.replace(scene, camera=dataclasses.replace(scene.camera, window=(-0.6, 0.4, -0.375, 0.375)))
    viewport.expect(moved, 2)  # as the reading thread says, while the renderer takes no messages
    viewport.run_slice()
    assert sent.shown == [(1, 0.0), (2, 0.0)]
    viewport.show(moved, 2, False)
    run_to_the_end(viewport)
    assert sorted(sent.shown) == sent.shown, "the view jumps back"
    assert sent.shown[-1] == (2, 1.0)
    _, other_sent = open_viewport(moved)
    assert 0.0 not in [progress for _, progress in other_sent.shown]
    np.testing.assert_array_equal(sent.picture, other_sent.picture)


def test_a_viewport_is_done_with_its_noise(open_viewport):
    noise = {"use_adaptive_sampling": True, "adaptive_threshold": 1.0, "adaptive_min_samples": 33}
    _, sent = open_viewport(with_settings(scene_of(), iterations=1000, **noise))
    status = sent.statuses[-1]
    assert status["settled"] and status["progress"]["iteration"] == 40
    assert 0.0 < status["progress"]["noise"] < status["progress"]["noise_threshold"] == 1.0
    assert sent.shown[-1] == (1, 1.0)


def turned(scene, columns):
    """The same, so many columns on."""
    left, right, bottom, top = scene.camera.window
    step = columns * (right - left) / scene.camera.width
    camera = dataclasses.replace(scene.camera, window=(left + step, right + step, bottom, top))
    return dataclasses.replace(scene, camera=camera)


def test_the_last_picture_moves_with_the_view_until_there_is_a_new_one(open_viewport):
    scene = scene_of()
    viewport, sent = open_viewport(scene)
    before, rendered = sent.picture, len(sent.statuses)
    viewport.show(turned(scene, 2), 2, True)
    viewport.run_slice()
    assert sent.shown[-1] == (2, 0.0) and len(sent.statuses) == rendered  # no iteration is done
    moved = sent.picture
    np.testing.assert_allclose(moved[:, :5], before[:, 2:7], atol=2e-3)
    viewport.show(turned(scene, 4), 3, True)
    run_to_the_end(viewport)
    generations = [generation for generation, _ in sent.shown]
    assert sorted(generations) == generations, "the view jumps back"
    assert sent.shown[-1] == (3, 1.0)
    _, other_sent = open_viewport(turned(scene, 4))
    np.testing.assert_array_equal(sent.picture, other_sent.picture)


def test_after_another_change_nothing_is_moved(open_viewport):
    viewport, sent = open_viewport(scene_of())
    seen = len(sent.frames)
    viewport.show(turned(scene_of(exposure=0.5), 2), 2, True)
    run_to_the_end(viewport)
    assert 0.0 not in [progress for _, progress in sent.shown[seen:]]


def test_the_memory_of_pictures_is_reported(open_viewport):
    viewport, sent = open_viewport(scene_of())
    reported = sent.statuses[-1]["progress"]["memory_bytes"]
    of_pictures = reported - sum(viewport.mapper.memory_bytes.values())
    assert 0 < of_pictures <= sum(expected_bytes(StageSizes(16, 12)).values())
