# SPDX-License-Identifier: GPL-3.0-or-later
"""The export benchmark's quick mode, as a program of its own."""

import json
import subprocess
import sys

import pytest

from benchmarks import ROOT

pytest.importorskip("bpy", reason="the export is Blender's")


@pytest.mark.long
def test_all_scenes_are_measured(tmp_path):
    output = tmp_path / "export.json"
    command = [sys.executable, "-m", "benchmarks.export.speed", "--quick", "--output", str(output)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, cwd=ROOT)
    assert done.returncode == 0, done.stderr
    scenes = json.loads(output.read_text())["scenes"]
    assert set(scenes) == {"wave", "shape_key", "objects", "collections", "geometry_nodes", "particles"}
    for name, figures in scenes.items():
        assert name in done.stdout
        assert figures["triangles"] > 500 and figures["instances"] >= (1 if figures["triangles"] > 5000 else 50)
        for stage in ("Blender", "export", "send", "receive", "upload", "gather", "others", "fresh export"):
            assert 0.0 < figures["stages"][stage]["wall_ms"] < 10_000.0
