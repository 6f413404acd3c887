# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures that a viewport shows before the renderer's first frame."""

import copy
import dataclasses

import numpy as np
import pytest
from support.floor import floor_scene

from rppm_addon.denoising.denoiser import Denoiser
from rppm_addon.gl.context.context import Context
from rppm_addon.gl.programs.programs import ProgramLibrary
from rppm_addon.scene import Panorama, PanoramaKind
from rppm_addon.scene.meshes import Dicing
from rppm_addon.session.placeholders.known_programs import MOST_TRIANGLES, KnownPrograms
from rppm_addon.session.viewport.viewport_renderer import ViewportRenderer


class Sent:
    """Messages that viewings have sent."""

    def __init__(self):
        self.messages = []

    def __call__(self, kind, **content):
        self.messages.append((kind, content))

    @property
    def frames(self):
        """Generation and progress of each."""
        return [(content["generation"], content["progress"]) for kind, content in self.messages if kind == "frame"]

    @property
    def compiled(self):
        statuses = [content["status"] for kind, content in self.messages if kind == "status"]
        return [status["programs_started"] for status in statuses if status["iteration"] == 0]


@pytest.fixture
def open_viewing():
    """A function that opens viewports of one process; they share what is compiled."""
    context = Context.create()
    library, known, opened = ProgramLibrary(context), KnownPrograms(), []

    def open_viewing():
        sent = Sent()
        opened.append(ViewportRenderer(context, library, Denoiser([]), sent, known))
        return opened[-1], sent

    yield open_viewing
    for viewing in opened:
        viewing.release()
    library.release()
    context.release()


def scene_of(**changes):
    scene = floor_scene()
    scene.settings = dataclasses.replace(scene.settings, iterations=2)
    return dataclasses.replace(scene, **changes)


def run(viewing):
    while viewing.busy:
        viewing.run_slice()


def last(viewing):
    """The bytes of the last frame."""
    height, width = 12, 16
    return viewing._frames._slots.pixels[viewing._frames._sequence % 3][: 4 * width * height].tobytes()


def test_a_first_look_comes_before_anything_is_compiled(open_viewing):
    viewing, sent = open_viewing()
    viewing.show(scene_of(), 1, False)
    viewing.run_slice()
    assert sent.frames == [(1, 0.0)]
    assert viewing._library.started == 2  # what gathers triangles, and what draws
    look = viewing._frames._slots.pixels[1][: 4 * 16 * 12].reshape(12, 16, 4)
    # The floor covers the left half.
    assert (look[:, :8, :3] > 0.1).all() and not look[:, 8:, :3].any()
    run(viewing)
    assert sent.frames[-1] == (1, 1.0) and sorted(sent.frames) == sent.frames
    assert [progress for _, progress in sent.frames].count(0.0) == 1
    assert sent.compiled == sorted(sent.compiled) and sent.compiled[-1] > 2


def test_there_is_none_once_there_was_a_frame(open_viewing):
    viewing, sent = open_viewing()
    viewing.show(scene_of(), 1, False)
    run(viewing)
    seen = len(sent.frames)
    viewing.show(scene_of(exposure=0.5), 2, False)
    run(viewing)
    assert 0.0 not in [progress for _, progress in sent.frames[seen:]] and sent.frames[-1] == (2, 1.0)


def test_there_is_none_when_the_programs_are_ready(open_viewing):
    for expected in (1, 0):
        viewing, sent = open_viewing()
        viewing.show(scene_of(), 1, False)
        run(viewing)
        assert [progress for _, progress in sent.frames].count(0.0) == expected


def test_large_scenes_and_new_materials_have_one_in_any_case(open_viewing):
    viewing, _ = open_viewing()
    viewing.show(scene_of(), 1, False)
    run(viewing)
    scene = scene_of()
    assert viewing._programs.cover(scene)
    glossy = dataclasses.replace(scene.materials[0], graph=dataclasses.replace(scene.materials[0].graph))
    glossy.graph.nodes = [dataclasses.replace(node, kind="bsdf_glossy") for node in glossy.graph.nodes]
    assert not viewing._programs.cover(dataclasses.replace(scene, materials=[glossy]))
    raised = dataclasses.replace(scene.materials[0], graph=copy.deepcopy(scene.materials[0].graph))
    raised.graph.displacement = raised.graph.add("displacement", "displacement", height=0.5)
    displaced = scene_of(materials=[raised])
    assert not viewing._programs.cover(displaced)
    other, _ = open_viewing()
    other.show(displaced, 1, False)
    run(other)
    assert viewing._programs.cover(displaced)
    divided = dataclasses.replace(scene.meshes[0], dicing=Dicing(1.0, True, False))
    assert viewing._programs.cover(scene_of(meshes=[divided]))
    assert not viewing._programs.cover(dataclasses.replace(displaced, meshes=[divided]))
    many = MOST_TRIANGLES // scene.meshes[0].triangle_count + 1
    assert not viewing._programs.cover(dataclasses.replace(scene, instances=scene.instances * many))


def test_panoramas_have_none(open_viewing):
    viewing, sent = open_viewing()
    camera = dataclasses.replace(
        scene_of().camera, panorama=Panorama(PanoramaKind.EQUIRECTANGULAR), window=(0.0, 1.0, 0.0, 1.0)
    )
    viewing.show(scene_of(camera=camera), 1, False)
    run(viewing)
    assert 0.0 not in [progress for _, progress in sent.frames] and sent.frames[-1] == (1, 1.0)


def test_it_follows_the_view_while_programs_are_compiled(open_viewing):
    viewing, sent = open_viewing()
    scene = scene_of()
    viewing.show(scene, 1, False)
    viewing.run_slice()
    moved = dataclasses.replace(scene, camera=dataclasses.replace(scene.camera, window=(-0.6, 0.4, -0.375, 0.375)))
    viewing.expect(moved, 2)  # as the reading thread says, while the renderer takes no messages
    viewing.run_slice()
    assert sent.frames == [(1, 0.0), (2, 0.0)]
    viewing.show(moved, 2, False)
    run(viewing)
    assert sorted(sent.frames) == sent.frames, "the view jumps back"
    assert sent.frames[-1] == (2, 1.0)
    other, other_sent = open_viewing()
    other.show(moved, 1, False)
    run(other)
    assert (0.0 not in [progress for _, progress in other_sent.frames]) and last(viewing) == last(other)


def test_a_viewport_is_done_with_its_noise(open_viewing):
    viewing, sent = open_viewing()
    settings = dataclasses.replace(
        floor_scene().settings, iterations=1000, use_adaptive_sampling=True, adaptive_threshold=1.0,
        adaptive_min_samples=33,
    )  # fmt: skip
    viewing.show(scene_of(settings=settings), 1, False)
    run(viewing)
    statuses = [content["status"] for kind, content in sent.messages if kind == "status"]
    assert statuses[-1]["settled"] and statuses[-1]["iteration"] == 40
    assert 0.0 < statuses[-1]["noise"] < statuses[-1]["noise_threshold"] == 1.0
    assert sent.frames[-1] == (1, 1.0)


def turned(scene, columns):
    """The same, so many columns on."""
    left, right, bottom, top = scene.camera.window
    step = columns * (right - left) / scene.camera.width
    return dataclasses.replace(
        scene, camera=dataclasses.replace(scene.camera, window=(left + step, right + step, bottom, top))
    )


def picture(viewing, sent):
    """The frame that was sent last."""
    frame = [content for kind, content in sent.messages if kind == "frame"][-1]
    pixels = viewing._frames._slots.pixels[frame["slot"]]
    return pixels[: 4 * 16 * 12].reshape(12, 16, 4).copy()


def test_the_last_picture_moves_with_the_view_until_there_is_a_new_one(open_viewing):
    viewing, sent = open_viewing()
    scene = scene_of()
    viewing.show(scene, 1, False)
    run(viewing)
    before, rendered = picture(viewing, sent), viewing._mapper.iteration
    viewing.show(turned(scene, 2), 2, True)
    viewing.run_slice()
    assert sent.frames[-1] == (2, 0.0) and viewing._mapper.iteration <= rendered
    moved = picture(viewing, sent)
    np.testing.assert_allclose(moved[:, :5], before[:, 2:7], atol=2e-3)
    viewing.show(turned(scene, 4), 3, True)
    run(viewing)
    generations = [generation for generation, _ in sent.frames]
    assert sorted(generations) == generations, "the view jumps back"
    assert sent.frames[-1] == (3, 1.0)
    other, other_sent = open_viewing()
    other.show(turned(scene, 4), 1, False)
    run(other)
    np.testing.assert_array_equal(picture(viewing, sent), picture(other, other_sent))


def test_after_another_change_nothing_is_moved(open_viewing):
    viewing, sent = open_viewing()
    viewing.show(scene_of(), 1, False)
    run(viewing)
    seen = len(sent.frames)
    viewing.show(turned(scene_of(exposure=0.5), 2), 2, True)
    run(viewing)
    assert 0.0 not in [progress for _, progress in sent.frames[seen:]]


def test_the_memory_of_pictures_is_told(open_viewing):
    viewing, sent = open_viewing()
    viewing.show(scene_of(), 1, False)
    run(viewing)
    told = [content["status"]["memory_bytes"] for kind, content in sent.messages if kind == "status"][-1]
    of_pictures = sum(viewing._viewport_pictures.memory_bytes.values())
    assert of_pictures > 0 and told == sum(viewing._mapper.memory_bytes.values()) + of_pictures
