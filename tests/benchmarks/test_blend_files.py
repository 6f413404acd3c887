# SPDX-License-Identifier: GPL-3.0-or-later
"""Files by others beside Cycles: which numbers the table shows."""

import pytest

from benchmarks.peers.blend_files import COMPARED, FileComparison, Row, table
from benchmarks.peers.files import PeersError


def rows():
    errors = {"rppm": 0.002, "cycles": 0.004, "rppm_denoised": 0.0005, "cycles_denoised": 0.001}
    flips = {"rppm": 0.3, "cycles": 0.4, "rppm_denoised": 0.03, "cycles_denoised": 0.02}
    for mark in (5.0, 20.0):
        for name in COMPARED:
            yield Row("car", name, mark, errors[name] / mark, flips[name], 1.01, 9.0, 2.5, 1e-6, 0.031)


def test_the_table_has_a_line_a_file_and_time_with_ratios():
    _, _, after_five, after_twenty = table(list(rows())).splitlines()
    cells = [cell.strip() for cell in after_five.strip("|").split("|")]
    assert cells[:5] == ["car", "5", "0.0004", "0.0008", "0.50"]
    assert cells[5:8] == ["0.030", "0.020", "1.50"]
    assert cells[-1] == "3.1%"
    assert after_twenty.startswith("| car | 20 | 0.0001 |")


def test_a_file_that_cannot_be_opened_is_named(tmp_path, monkeypatch):
    monkeypatch.setattr("benchmarks.peers.blend_files._FOLDER", tmp_path)
    source = tmp_path / "no.blend"
    source.write_bytes(b"no file of Blender's")
    with pytest.raises(PeersError, match=r"staged\.blend could not be made"):
        FileComparison("32x18", [1.0], 1.0).rows(source)
