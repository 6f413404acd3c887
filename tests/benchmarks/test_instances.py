# SPDX-License-Identifier: GPL-3.0-or-later
"""The benchmark of instances, of small scenes, as a program of its own."""

import subprocess
import sys

import pytest
from support.floor import floor_scene

from benchmarks import ROOT
from benchmarks.instances.moves import moving_member
from rppm_addon.scene import Instance
from rppm_addon.scene.storage.storage import save_scene
from rppm_addon.self_test.meshes import placed, sphere

pytest.importorskip("bpy", reason="the scenes are Blender's")


@pytest.mark.long
def test_both_engines_are_measured(tmp_path):
    scene = floor_scene()
    scene.meshes.append(sphere("ball"))
    scene.instances.append(Instance(len(scene.meshes) - 1, placed(0, 0, 0.5, 0.1), [0], "ball"))
    assert scene.instances[moving_member(scene)].object_name == "ball"
    saved = tmp_path / "floor.npz"
    save_scene(scene, saved)
    command = [sys.executable, "-m", "benchmarks.instances", "--divisor", "1000", "--folder", str(tmp_path)]
    command += ["--moves", str(saved), "--frames", "3"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, cwd=ROOT)
    assert done.returncode == 0, done.stderr
    assert {path.name for path in tmp_path.glob("*.blend")} == {"forest_1000_100.blend", "city_50_4.blend"}
    rows = [line.split(" | ") for line in done.stdout.splitlines() if line.startswith("| ") and line[2:3].islower()]
    measured = [row for row in rows if row[0] in ("| rppm", "| cycles")]
    assert len(measured) == 4 and rows[-1][0] == "| floor"
    for row in measured:
        blender, peak = map(float, row[1:3])
        assert 0.1 < blender < peak < 4.0
