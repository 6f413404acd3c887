# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies with a medium inside: whether they have an inside."""

import dataclasses

import numpy as np
import pytest
from support.floor import floor_scene
from support.lobes import Lobe, LobeKind, material

from rppm_addon.integrator.surfaces.bodies import is_closed, warn_of_open_bodies
from rppm_addon.self_test.meshes import rectangle, sphere


def without(mesh, count):
    return dataclasses.replace(
        mesh, triangle_corners=mesh.triangle_corners[count:], triangle_slots=mesh.triangle_slots[count:]
    )


def unwelded(mesh):
    """Each corner with a vertex of its own, as many files have meshes."""
    corners = np.arange(len(mesh.corner_vertices), dtype=np.int32)
    return dataclasses.replace(mesh, positions=mesh.positions[mesh.corner_vertices], corner_vertices=corners)


@pytest.mark.parametrize("change", [lambda mesh: mesh, unwelded])
def test_a_ball_is_closed_and_one_with_a_hole_is_not(change):
    ball = change(sphere("ball"))
    assert is_closed(ball)
    assert not is_closed(without(ball, 1))


def test_a_face_turned_around_is_a_hole():
    ball = sphere("ball")
    corners = ball.triangle_corners.copy()
    corners[40] = corners[40, ::-1]
    assert not is_closed(dataclasses.replace(ball, triangle_corners=corners))


def test_only_what_is_filled_is_warned_of():
    scene = floor_scene()
    scene.materials.append(material("water", Lobe(LobeKind.TRANSPARENT), absorption=np.ones(3)))
    checked = {}
    warn_of_open_bodies(scene, {1}, checked)
    assert scene.warnings == []
    scene.instances[0].materials[:] = [1]
    warn_of_open_bodies(scene, {1}, checked)
    (text,) = scene.warnings
    assert '"Floor"' in text and "holes" in text
    assert not is_closed(rectangle("card", (0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)))
