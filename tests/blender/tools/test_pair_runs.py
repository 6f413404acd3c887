# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of tools/pairs that need Blender: equal settings, what Cycles gets wrong, and whole runs."""

import subprocess
import sys
from pathlib import Path

import bpy
import numpy as np
import pytest

from rppm_addon.blender.export import export_scene
from tests.parity.scenes import DIFFUSE, ball, camera, light, material, new_scene, place, plane
from tools.pairs.settings import BOUNCES, Effort, equalize
from tools.pairs.suspects import coincident_pixels, suspects_of

ROOT = Path(__file__).parents[3]


def suspects() -> list[str]:
    return suspects_of(export_scene(bpy.context.evaluated_depsgraph_get()))


@pytest.mark.parametrize("orthographic", [False, True])
def test_coincident_faces_are_found(registered, orthographic):
    new_scene()
    plane(1.0, material(DIFFUSE))
    camera((0.0, -1.0, 4.0), (0.0, 0.0, 0.0))
    bpy.context.scene.camera.data.type = "ORTHO" if orthographic else "PERSP"
    assert suspects() == []
    plane(0.4, material(DIFFUSE), place(at=(0.2, 0.3, 0.0), turn=(0.0, 0.0, 20.0)))
    (told,) = suspects()
    assert told.startswith("coincident faces in ")
    assert "(Mesh and Mesh.001)" in told


def test_pixels_that_show_coincident_faces_are_found(registered):
    new_scene()
    plane(1.0, material(DIFFUSE))
    plane(0.25, material(DIFFUSE), place(at=(0.5, 0.5, 0.0)))
    camera((0.0, 0.0, 4.0), (0.0, 0.0, 0.0))
    bpy.context.scene.camera.data.type = "ORTHO"
    bpy.context.scene.camera.data.ortho_scale = 2.0
    bpy.context.scene.render.resolution_x = bpy.context.scene.render.resolution_y = 16
    found = coincident_pixels(export_scene(bpy.context.evaluated_depsgraph_get()), 16, 16)
    expected = np.zeros((16, 16), bool)
    expected[2:6, 10:14] = True  # the upper right
    np.testing.assert_array_equal(found, expected)


def test_faces_that_are_near_are_not_coincident(registered):
    new_scene()
    plane(1.0, material(DIFFUSE))
    plane(0.4, material(DIFFUSE), place(at=(0.2, 0.3, 1e-4)))
    ball(0.5, material(DIFFUSE))  # cuts both
    camera((0.0, -1.0, 4.0), (0.0, 0.0, 0.0))
    assert suspects() == []


def test_lamps_in_a_surface_are_found(registered):
    new_scene()
    plane(1.0, material(DIFFUSE))
    camera((0.0, -1.0, 4.0), (0.0, 0.0, 0.0))
    light("POINT", 10.0, place((0.3, 0.1, 1e-3)))
    light("AREA", 10.0, place((0.3, 0.1, 0.0), turn=(90.0, 0.0, 0.0)))  # stands on it
    assert suspects() == []
    light("AREA", 10.0, place((0.3, 0.1, 0.0))).name = "Ceiling"
    light("POINT", 10.0, place((0.1, 0.1, 0.0))).name = "Bulb"
    assert suspects() == ["lamps exactly in a surface: Bulb, Ceiling"]


def test_settings_are_equal(registered):
    scene = new_scene()
    scene.cycles.sample_clamp_indirect, scene.cycles.blur_glossy = 10.0, 1.0
    scene.render.use_freestyle = scene.render.use_border = True
    equalize(scene, Effort((96, 72), 8, 16, 5.0))
    assert (scene.cycles.sample_clamp_indirect, scene.cycles.blur_glossy) == (0.0, 0.0)
    assert not scene.render.use_freestyle
    assert not scene.render.use_border
    assert (scene.render.resolution_x, scene.render.resolution_y) == (96, 72)
    assert scene.cycles.diffuse_bounces == scene.rppm.max_bounces == BOUNCES


@pytest.mark.long
def test_a_file_that_fails_does_not_stop_the_others(tmp_path):
    """And what is there is not rendered again."""
    new_scene(world=0.5)
    ball(0.5, material(DIFFUSE))
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "good.blend"))
    (tmp_path / "bad.blend").write_bytes(b"no such thing")
    command = [sys.executable, "-m", "tools.pairs", str(tmp_path), "--out", str(tmp_path / "out")]
    command += ["--resolution", "32x24", "--samples", "2", "--cycles-samples", "2"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=300)
    assert done.returncode == 1
    _, bad, good = done.stdout.splitlines()
    assert bad.split()[:3] == ["bad", "FAILED", "opening:"]
    assert good.startswith("good ")
    assert "FAILED" not in good
    assert (tmp_path / "out" / "good.png").exists()
    written = (tmp_path / "out" / "good.npz").stat().st_mtime_ns
    again = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=60)
    assert again.stdout == done.stdout
    assert (tmp_path / "out" / "good.npz").stat().st_mtime_ns == written
