# SPDX-License-Identifier: GPL-3.0-or-later
"""Command lines that cannot be meant, and pictures that are none: a line and an exit status, and no file is lost."""

import dataclasses
import logging
import os
import pwd
import tempfile

import numpy as np
import pytest
from support.floor import floor_scene

from rppm_addon.cli import main
from rppm_addon.commands.picture_files import is_whole
from rppm_addon.commands.terminal.texts import LineFormatter
from rppm_addon.gl.context.context import Context
from rppm_addon.gl.programs.binary_cache import cache_folder
from rppm_addon.pictures import read_exr, write_exr
from rppm_addon.scene import save_scene


def told(capsys):
    error = capsys.readouterr().err
    assert error.count("\n") == 1 and error.startswith("rppm: ") and "unexpected" not in error, error
    return error


@pytest.mark.parametrize("clash", ["scene", "picture", "checkpoint", "snapshot", "link"])
def test_a_report_replaces_no_other_file(tmp_path, saved_scene, capsys, clash):
    picture, link = tmp_path / "a.exr", tmp_path / "link.json"
    report = {
        "scene": saved_scene, "picture": picture, "checkpoint": tmp_path / "c.exr", "snapshot": tmp_path / "a_1s.exr",
        "link": link,
    }[clash]  # fmt: skip
    link.symlink_to(saved_scene)
    before = saved_scene.read_bytes()
    files = ["-o", str(picture), "--checkpoint", str(tmp_path / "c.exr"), "--snapshots", "1"]
    assert main(["render", str(saved_scene), *files, "--json", str(report)]) == 1
    assert "give the report a name of its own" in told(capsys)
    assert saved_scene.read_bytes() == before and not picture.exists()


@pytest.mark.parametrize("command", ["merge", "inspect", "info"])
def test_reports_of_other_commands(tmp_path, saved_scene, capsys, command):
    report = str(tmp_path / "a.exr")
    arguments = {
        "merge": ["merge", report, "-o", str(tmp_path / "b.exr"), "--json", report],
        "inspect": ["inspect", str(saved_scene), "-o", report, "--json", report],
        "info": ["info", "--scene", str(saved_scene), "--json", str(saved_scene)],
    }
    assert main(arguments[command]) == 1
    assert "--json" in told(capsys)


def test_a_picture_that_is_not_finite_does_not_pass(tmp_path, capsys):
    """Light beyond single precision: what there is is written, the status says that it is none."""
    scene = floor_scene()
    scene.lights[0].strength = np.full(3, 1e30)
    scene = dataclasses.replace(scene, exposure=1e12)
    save_scene(scene, tmp_path / "bright.npz")
    picture = tmp_path / "a.exr"
    assert main(["render", str(tmp_path / "bright.npz"), "-o", str(picture)]) == 1
    assert "no finite number" in capsys.readouterr().err.splitlines()[-1]
    assert not np.isfinite(read_exr(picture).combined).all()
    assert not is_whole(picture)


def test_pictures_that_are_whole_are_finite(tmp_path):
    pixels = np.zeros((4, 4, 4), np.float32)
    write_exr(tmp_path / "a.exr", pixels, {"Depth": np.full((4, 4), np.inf, np.float32)})
    assert is_whole(tmp_path / "a.exr")  # what is infinitely far away
    pixels[2, 1, 0] = np.nan
    write_exr(tmp_path / "a.exr", pixels)
    assert not is_whole(tmp_path / "a.exr")


def test_names_cannot_speak_to_the_terminal(tmp_path, capsys, caplog):
    scene = floor_scene()
    scene.lights[0].name = "\x1b]0;owned\x07\nrppm: all is well"
    scene.lights[0].radius = float("nan")
    save_scene(scene, tmp_path / "a.npz")
    assert main(["render", str(tmp_path / "a.npz"), "-o", str(tmp_path / "\udcff.exr")]) == 1
    error = told(capsys)
    assert error.isascii() and "\x1b" not in error and r"\x1b]0;owned\x07\n" in error


def test_warnings_are_lines(capsys):
    record = logging.LogRecord("rppm", logging.WARNING, "", 0, 'object "\x1b[2J\n" is missing', (), None)
    assert LineFormatter("rppm: %(message)s").format(record) == r'rppm: object "\x1b[2J\n" is missing'


def test_another_engine_is_refused_before_blender_starts(tmp_path, capsys):
    blend = tmp_path / "a.blend"
    blend.touch()
    assert main(["render", str(blend), "-o", str(tmp_path / "a.exr"), "--set", "render.engine=CYCLES"]) == 1
    assert "rppm renders with RPPM only" in told(capsys)


def test_without_a_home(monkeypatch, tmp_path):
    """As for a user of a container: no HOME, and no entry in the list of users."""
    for name in ("RPPM_CACHE", "XDG_CACHE_HOME", "HOME"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(pwd, "getpwuid", {}.__getitem__)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    assert cache_folder() == tmp_path / f"rppm-{os.getuid()}" / "programs"


def test_too_little_memory_is_no_fault_to_report(saved_scene, tmp_path, capsys, monkeypatch):
    def fail(*_):
        raise MemoryError

    monkeypatch.setattr(Context, "create", fail)
    assert main(["render", str(saved_scene), "-o", str(tmp_path / "a.exr")]) == 1
    assert capsys.readouterr().err.splitlines()[-1].startswith("rppm: there is not enough memory; lower the resolution")
