# SPDX-License-Identifier: GPL-3.0-or-later
"""The built extension, installed and in use in each Blender that it claims: ``make test-wheels``."""

import functools
import json
import os
import subprocess
from pathlib import Path

import numpy as np
import OpenEXR
import pytest
from environments import CURRENT, LOCKS, python_with_blender
from support.extension_zip import built_zip

AS_USER = Path(__file__).with_name("as_user.py")


def as_user(python, folder, *arguments):
    """Return the report of as_user.py, run in a Blender whose user folder is ``folder``/user."""
    run = subprocess.run(
        [python, AS_USER, *arguments],
        env=os.environ | {"BLENDER_USER_RESOURCES": str(folder / "user"), "PYTHONPATH": ""},
        cwd=folder, capture_output=True, text=True, timeout=900,
    )  # fmt: skip
    assert run.returncode == 0, run.stdout + run.stderr
    assert "Traceback" not in run.stderr, run.stderr
    return json.loads(run.stdout.strip().splitlines()[-1])


def read(picture):
    """(height, width, 3) float32."""
    with OpenEXR.File(str(picture)) as file:
        channels = file.channels()
        name = next(name for name in ("RGB", "RGBA", "Combined") if name in channels)
        return channels[name].pixels[..., :3]


@pytest.fixture(scope="module")
def used(tmp_path_factory):
    """Installs and uses the zip in a version of Blender, once: the report, and the folder with the pictures."""
    archive = built_zip(tmp_path_factory.mktemp("extension"))

    @functools.cache
    def used(version):
        folder, python = tmp_path_factory.mktemp(version), python_with_blender(version)
        assert as_user(python, folder, "install", archive) == {"enabled": True}
        return as_user(python, folder, "use", folder), folder

    return used


@pytest.mark.parametrize("version", LOCKS)
def test_the_zip_is_installed_and_renders_the_same(version, used):
    report, folder = used(version)
    assert report["blender"].startswith(version.rpartition(".")[0])
    assert Path(report["moderngl"]).is_relative_to(folder / "user"), "the wheel is not what was imported"
    assert report["here"] == report["process"] == {"warnings": [], "samples": 16}
    np.testing.assert_array_equal(read(folder / "here.exr"), read(folder / "process.exr"))
    seen, current = read(folder / "here.exr"), read(used(CURRENT)[1] / "here.exr")
    np.testing.assert_allclose(seen.mean((0, 1)), current.mean((0, 1)), rtol=0.01)
    blocks = [picture.reshape(9, 8, 12, 8, 3).mean((1, 3)) for picture in (seen, current)]
    assert np.abs(blocks[0] - blocks[1]).mean() < 0.03 * blocks[1].mean()


def test_a_raycast_samples_meshes_that_come_before_it(used):
    found = used("5.2.3")[0]["raycast"]
    assert sorted(found) == ["Heat", "Heat", "bsdf_principled", "cast_attribute", "emission", "raycast"]


def test_a_raycast_is_exported_before_it_samples_attributes(used):
    """Blender 5.1 has the node, and 5.2 its attributes."""
    assert sorted(used("5.1.2")[0]["raycast"]) == ["bsdf_principled", "emission", "raycast"]


@pytest.mark.parametrize("version", LOCKS)
def test_what_the_window_needs_is_there(version, used):
    report, _ = used(version)
    assert report["engine"] == {"bl_use_preview": True, "bl_use_eevee_viewport": True, "viewport": True}
    assert report["presets"] == {"Draft": 32, "Balanced": 128, "Final": 512}
    assert len(report["panels"]) > 20 and "RPPM_PT_status" in report["panels"]
    assert report["left"] == []
