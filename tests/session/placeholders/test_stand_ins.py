# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials that something stands in for until their programs are compiled, in a viewport."""

import dataclasses

import numpy as np
import pytest
from session.conftest import with_settings
from session.frame_receiver import FrameReceiver
from support.floor import floor_scene
from support.graphs import surface_graph

from rppm_addon.denoising.denoiser import Denoiser
from rppm_addon.scene import Material
from rppm_addon.session.placeholders import stand_ins
from rppm_addon.session.placeholders.known_programs import KnownPrograms
from rppm_addon.session.placeholders.stand_ins import StandIns
from rppm_addon.session.viewport.viewport_renderer import ViewportRenderer


class Compiling:
    """In a library's place: programs that are compiled until ``ready`` names the kinds of their nodes."""

    def __init__(self):
        self.ready = set()

    def has_stand_in(self, path, inserts):
        (text,) = inserts.values()
        return not any(f"node_{kind}" in text for kind in self.ready)


def plain(kind):
    return Material(kind, surface_graph(kind))


KINDS = ("bsdf_diffuse", "bsdf_glossy", "bsdf_glass", "bsdf_transparent")


@pytest.fixture
def scene():
    return dataclasses.replace(floor_scene(), materials=[plain(kind) for kind in KINDS])


def stood_in_for(scene, shown):
    return [kind for kind, old, new in zip(KINDS, scene.materials, shown.materials, strict=True) if old is not new]


def test_each_is_replaced_until_its_own_program_is_ready(scene, monkeypatch):
    library, now = Compiling(), [100.0]
    monkeypatch.setattr(stand_ins.time, "perf_counter", lambda: now[0])
    found = StandIns(library)
    shown = found.replace(scene)
    assert stood_in_for(scene, shown) == list(KINDS) and found.count == 4 and not found.due
    library.ready = {"bsdf_glossy"}
    assert not found.due  # the picture would begin anew too often
    now[0] += stand_ins.EXCHANGE_SECONDS
    assert found.due
    later = found.replace(scene)
    assert stood_in_for(scene, later) == [KINDS[0], *KINDS[2:]]
    assert later.materials[0] is shown.materials[0]  # what stays need not be uploaded again
    library.ready = set(KINDS)
    assert found.due
    assert found.replace(scene) is scene and found.count == 0 and not found.due


def test_a_scene_seen_from_elsewhere_has_the_same_stand_ins(scene):
    """Else a picture of them could not be moved with the view."""
    found, elsewhere = StandIns(Compiling()), dataclasses.replace(scene, camera=dataclasses.replace(scene.camera))
    assert found.as_shown(scene) is scene
    shown, moved = found.replace(scene), found.as_shown(elsewhere)
    assert all(a is b for a, b in zip(shown.materials, moved.materials, strict=True))
    other = dataclasses.replace(scene, materials=[plain("emission")])
    assert found.as_shown(other) is other


def test_few_programs_are_waited_for_unless_the_stand_ins_are_there(scene):
    library = Compiling()
    found = StandIns(library)
    library.ready = set(KINDS[1:])
    assert found.replace(scene) is scene and not found.due
    library.ready = set()
    found.replace(scene)
    library.ready = set(KINDS[1:])
    assert stood_in_for(scene, found.replace(scene)) == [KINDS[0]]


def test_the_picture_begins_anew_with_what_is_ready(device, monkeypatch):
    """And ends as that of a scene which nothing stood in for."""
    library, known = Compiling(), KnownPrograms()
    scene = with_settings(floor_scene(), iterations=2)
    # Of the structure that faces without a material have: nothing is compiled for it.
    black = surface_graph("bsdf_diffuse", color=0.0)
    monkeypatch.setattr(stand_ins, "stand_in_graph", lambda graph, images: black)
    monkeypatch.setattr(stand_ins, "FEWEST_PROGRAMS", 1)
    pictures = {}
    for waits in (False, True):
        if waits:
            monkeypatch.setattr(device[1], "has_stand_in", library.has_stand_in)
        sent = FrameReceiver()
        viewport = ViewportRenderer(*device, Denoiser([]), sent, known)
        viewport.show(scene, 1, False)
        while viewport.busy:
            viewport.run_slice()
            if waits and len(sent.frames) == 2:
                library.ready = {"bsdf_diffuse"}
        pictures[waits] = [frame.combined for frame in sent.frames if frame.progress]
        viewport.release()
    assert {status["compilation"]["stood_in_for"] for status in sent.statuses} == {0, 1}
    assert not any(status["settled"] for status in sent.statuses if status["compilation"]["stood_in_for"])
    assert not pictures[True][1][:, :8, :3].any() and pictures[True][-1][:, :8, :3].any()
    np.testing.assert_array_equal(pictures[True][-1], pictures[False][-1])
