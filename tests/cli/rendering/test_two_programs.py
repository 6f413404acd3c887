# SPDX-License-Identifier: GPL-3.0-or-later
"""Two renders that begin at once where nothing is compiled yet."""

import numpy as np
import pytest
from cli.conftest import start_rppm

from rppm_addon.pictures import read_exr


@pytest.mark.long
def test_both_fill_the_same_folder_of_programs(saved_scene, tmp_path, monkeypatch):
    programs = tmp_path / "programs"
    monkeypatch.setenv("RPPM_CACHE", str(programs))
    monkeypatch.setenv("MESA_SHADER_CACHE_DIR", str(tmp_path / "mesa"))
    options = ["--samples", "2", "--resolution", "16x16"]
    pictures = [tmp_path / f"{name}.exr" for name in ("first", "second", "third")]
    processes = [start_rppm("render", saved_scene, "-o", path, *options) for path in pictures[:2]]
    for process in processes:
        output, errors = process.communicate(timeout=300)
        assert process.returncode == 0, errors
    kept = {path.name for path in programs.rglob("*") if path.is_file()}
    with start_rppm("render", saved_scene, "-o", pictures[2], *options) as process:
        assert process.wait(120) == 0
    found = {path.name for path in programs.rglob("*") if path.is_file()}
    # Programs that no sample has needed may be compiled in the background later.
    assert found >= kept and len(kept) > 20
    assert all(name.endswith(".bin") for name in found)  # nothing is left half-written
    first, *others = (read_exr(path).combined for path in pictures)
    for other in others:
        np.testing.assert_array_equal(other, first)
