# SPDX-License-Identifier: GPL-3.0-or-later
"""The viewport benchmark, small, as a program of its own."""

import json
import subprocess
import sys

import pytest

from benchmarks import ROOT

pytest.importorskip("bpy", reason="Cycles is Blender's")
pytest.importorskip("flip_evaluator", reason="it is of the bench extra")


@pytest.mark.long
def test_a_scene_is_measured(tmp_path):
    options = f"--scenes cube --size 32x18 --seconds 0.2,0.4 --reference 0.5 --save {tmp_path}"
    command = [sys.executable, "-m", "benchmarks.viewport", *options.split()]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, cwd=ROOT)
    assert done.returncode == 0, done.stderr
    (scene,) = json.loads((tmp_path / "figures.json").read_text())["scenes"]
    assert scene["scene"] == "cube" and "| cube | 0.2 |" in done.stdout and (tmp_path / "sheet.png").exists()
    assert [found["seconds"] for found in scene["marks"]] == [0.2, 0.4]
    for found in scene["marks"]:
        assert all(0.0 <= found[f"flip_{way}"] < 0.5 for way in ("noisy", "shown", "cycles"))
    assert scene["orbit"]["shown"] >= scene["orbit"]["rendered"] > 0.0
