# SPDX-License-Identifier: GPL-3.0-or-later
"""The small files that tools/beginner_files makes."""

import subprocess
import sys
from pathlib import Path

import bpy
import pytest

from rppm_addon.blender.export import export_scene
from tools.beginner_files import __main__ as _  # noqa: F401 (its modules list their files)
from tools.beginner_files.files import FILES, SIZE, file


def test_there_are_hundreds_by_names_of_their_own():
    assert len(FILES) > 700
    with pytest.raises(ValueError, match="two files"):
        file("copies_full", print)


@pytest.mark.parametrize(
    "name",
    ["add_text_solid", "copies_materials", "nodes_scatter", "light_area_disk", "collection_holdout", "image_box"],
)
def test_files_have_all_that_a_render_needs(registered, name):
    FILES[name]()
    scene = export_scene(bpy.context.evaluated_depsgraph_get()).expanded()
    assert scene.warnings == []
    assert scene.camera.resolution == SIZE
    assert len(scene.instances) > 1
    assert scene.lights


@pytest.mark.long
def test_files_after_one_with_a_fluid_are_written(tmp_path):
    """Blender's module aborts as it frees the fluid."""
    names = ["quick_smoke", "add_mesh_cube_flat"]
    command = [sys.executable, "-m", "tools.beginner_files", str(tmp_path), *names]
    done = subprocess.run(command, cwd=Path(__file__).parents[3], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    assert sorted(path.stem for path in tmp_path.glob("*.blend")) == sorted(names)
