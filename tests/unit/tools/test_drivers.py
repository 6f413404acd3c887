# SPDX-License-Identifier: GPL-3.0-or-later
"""Driver lab: its reading of what drivers print. Nothing is compiled."""

import sys

import pytest

from benchmarks.drivers import lab, statistics
from benchmarks.drivers.lab import DRIVERS, Driver
from benchmarks.drivers.limits import Limits
from benchmarks.drivers.programs import Program, all_programs
from benchmarks.drivers.statistics import Statistics, worst
from rppm_addon.gl.programs.sources import SHADER_FOLDER, Source

LINES = {
    statistics.radeonsi: "Shader Stats: SGPRS: 80 VGPRS: 128 Code Size: 24404 LDS: 0 Scratch: 12288 Max Waves: 5 "
    "Spilled SGPRs: 2 Spilled VGPRs: 130 PrivMem VGPRs: 0 (CS, W64)",
    statistics.nouveau: "type: 5, local: 8, shared: 0, gpr: 177, inst: 7258, bytes: 77424, cached: 176340",
    statistics.iris: "SIMD8 shader: 1685 instructions. 8 loops. 355620672 cycles. 221:300 spills:fills, 38 sends",
    statistics.asahi: "CS shader: 34 instrs, 13 gprs, 22 uniforms, 0 scratch, 1024 threads, 0 loops, 1:2 spills:fills",
}
FOUND = [Statistics(128, 132, 5), Statistics(177, 2, 11), Statistics(0, 521, 8), Statistics(13, 3, 1024)]
LIGHT, HEAVY = Statistics(24, 0, 16), Statistics(168, 0, 3)


@pytest.mark.parametrize("read, expected", list(zip(LINES, FOUND, strict=True)))
def test_statistics_are_read(read, expected):
    assert read(f"noise\n{LINES[read]}\n") == [expected]
    assert read("noise") == []


def test_the_worst_stage_counts():
    assert worst([LIGHT, HEAVY, Statistics(30, 7, 16)]) == Statistics(168, 7, 3)
    assert worst([]) is None


def test_programs_are_all_stage_files():
    names = {source.files[0] for program in all_programs() for source in program.stages.values()}
    files = {path.relative_to(SHADER_FOLDER).as_posix() for path in SHADER_FOLDER.rglob("*.*")}
    assert names == {name for name in files if not name.endswith(".glsl")}


def test_each_program_has_what_was_said_of_it():
    programs = [Program(name, {"comp": Source(name, [name])}) for name in ("sound", "dropped", "silent", "refused")]
    driver = Driver("any", "shim", {}, "", statistics.nouveau, 64)
    line = LINES[statistics.nouveau]
    printed = f"start\n@@ 0\n{line}\n@@ 1\n{line}\nERROR: unknown nir_op unpack\nno end of line@@ 2\n\n@@ 3\n"
    rows = [{"seconds": 1.0, "messages": [], "error": ""} for _ in programs]
    rows[3]["error"] = "0:1: wrong"
    found = {"device": "D", "version": "V", "limits": {}, "programs": rows}
    outcome = lab.outcome_of(driver, programs, found, printed)
    errors = [outcome.rows[program.digest].error for program in programs]
    assert errors == ["", "ERROR: unknown nir_op unpack", "the driver has made no code of it", "0:1: wrong"]


def test_a_driver_that_takes_too_long_is_named(monkeypatch, tmp_path):
    monkeypatch.setattr(lab, "LONGEST_SECONDS", 0.1)
    monkeypatch.setattr(lab, "lab_folder", lambda: tmp_path)
    monkeypatch.setattr(
        lab, "_command", lambda driver, folder: ([sys.executable, "-c", "import time; time.sleep(60)"], {})
    )
    driver = Driver("slow card", "shim", {}, "", statistics.nouveau, 64)
    with pytest.raises(lab.LabError, match="slow card did not compile 1 programs in 0.1 s"):
        lab.compile_all(driver, [Program("any", {"comp": Source("any", ["any"])})])


def test_heavy_programs_may_not_get_worse(tmp_path):
    limits = Limits()
    limits.keep("card", "1.0", {"light": LIGHT, "heavy": HEAVY, "spills": Statistics(100, 20, 8)}, 16)
    assert limits.heavy.keys() == {"heavy", "spills"}
    limits.store(tmp_path / "limits.json")
    assert Limits.load(tmp_path / "limits.json") == limits
    for name, code, words in (
        ("light", Statistics(60, 0, 4), ""),
        ("light", HEAVY, "it was light"),
        ("light", Statistics(60, 1, 4), "it was light"),
        ("heavy", HEAVY, ""),
        ("heavy", Statistics(200, 0, 2), "3 so far"),
        ("spills", Statistics(100, 22, 8), ""),
        ("spills", Statistics(100, 23, 8), "20 so far"),
    ):
        complaint = limits.complaint(name, "card", code, 16)
        assert words in complaint and bool(complaint) == bool(words), (name, complaint)
    limits.keep("card", "1.1", {"heavy": LIGHT}, 16)
    assert limits.heavy == {} and limits.versions == {"card": "1.1"}


def test_limits_are_of_drivers_and_programs_that_there_are():
    limits, names = Limits.load(), {program.name for program in all_programs()}
    assert limits.heavy.keys() <= names
    drivers = {driver.name for driver in DRIVERS}
    assert limits.versions.keys() == drivers
    assert {name for found in limits.heavy.values() for name in found} <= drivers
