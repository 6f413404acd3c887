# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that are replaced when the new one is whole, and not before."""

import contextlib
import os
import resource
import signal
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from support.floor import floor_scene

from rppm_addon.cli import main
from rppm_addon.pictures import PictureError, make_folder, read_exr, write_exr
from rppm_addon.scene import Image, save_scene
from rppm_addon.scene.common import whole_files
from rppm_addon.scene.common.whole_files import renamed_when_whole


@contextlib.contextmanager
def full_disk(free=1 << 12):
    """As if no file could become larger."""
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (free, limits[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)


def large_scene():
    scene = floor_scene()
    scene.images.append(Image("Noise", np.random.default_rng(0).random((256, 64, 4), np.float32)))
    return scene


def write_noise(side, path):
    write_exr(path, np.random.default_rng(0).random((side, side, 4), np.float32))


@pytest.mark.parametrize(
    ("write", "small", "large", "error", "words"),
    [
        (save_scene, floor_scene(), large_scene(), OSError, None),
        (write_noise, 4, 64, PictureError, "choose another place"),
    ],
    ids=["scene", "picture"],
)
def test_a_full_disk_leaves_the_file_of_before(tmp_path, write, small, large, error, words):
    path = tmp_path / "file.exr"
    write(small, path)
    before = path.read_bytes()
    with full_disk(), pytest.raises(error, match=words):
        write(large, path)
    assert path.read_bytes() == before and list(tmp_path.iterdir()) == [path]


def test_two_who_write_one_file_leave_one_of_them_whole(tmp_path):
    """As two renders do that are given the same name; whoever reads meanwhile sees a whole one as well."""
    path = tmp_path / "picture.exr"
    write_exr(path, np.zeros((16, 16, 4), np.float32))

    def write(value):
        for _ in range(10):
            write_exr(path, np.full((16, 16, 4), value, np.float32))

    with ThreadPoolExecutor(2) as pool:
        writers = [pool.submit(write, value) for value in (1.0, 2.0)]
        while not all(writer.done() for writer in writers):
            picture = read_exr(path).combined
            assert np.ptp(picture) == 0.0
    for writer in writers:
        writer.result()
    assert read_exr(path).combined[0, 0, 0] in (1.0, 2.0) and list(tmp_path.iterdir()) == [path]


def test_where_nothing_can_be_written_is_told_before_a_render(tmp_path):
    """Also to root, who is denied nothing."""
    make_folder(tmp_path / "new" / "picture.exr")
    assert not any((tmp_path / "new").iterdir())
    for path in ("/proc/picture.exr", "/proc/new/picture.exr", "/dev/null/picture.exr"):
        with pytest.raises(PictureError, match="cannot be written .*choose another place"):
            make_folder(Path(path))


def test_export_says_in_a_line_that_the_disk_is_full(tmp_path, monkeypatch, capsys):
    from rppm_addon.commands.blend_files import blend_file

    monkeypatch.setattr(blend_file, "export_blend_file", lambda *given, **named: large_scene())
    with full_disk():
        status = main(["export", "a.blend", "-o", str(tmp_path / "a.npz")])
    error = capsys.readouterr().err
    assert status == 1 and error.startswith(f"rppm: {tmp_path}/a.npz cannot be written") and error.count("\n") == 1
    assert not list(tmp_path.iterdir())


KILLED = """
import os, signal, sys
from rppm_addon.scene.common import whole_files
from rppm_addon.scene.common.whole_files import renamed_when_whole
with renamed_when_whole(sys.argv[1]) as temporary:
    open(temporary, "w").write("half")
    os.kill(os.getpid(), signal.SIGKILL)
"""


def test_what_a_killed_process_left_is_removed(tmp_path):
    path = tmp_path / "still.cp.exr"
    path.write_text("before")
    beside = [tmp_path / ".still.cp.elsewhere-77-abc.exr", tmp_path / ".still.cp.exr", tmp_path / ".still.cp.x.exr"]
    for other in beside:
        other.touch()
    assert subprocess.run([sys.executable, "-c", KILLED, str(path)]).returncode == -signal.SIGKILL
    assert path.read_text() == "before" and len(list(tmp_path.iterdir())) == 5
    with renamed_when_whole(path) as temporary, renamed_when_whole(path) as at_the_same_time:
        for name, text in ((temporary, "one"), (at_the_same_time, "other")):
            Path(name).write_text(text)
    assert path.read_text() == "one"
    assert sorted(tmp_path.iterdir()) == sorted([path, *beside])


@pytest.mark.parametrize("stem", ["n" * 250, "\N{SNOWMAN}" * 83, "x" + "\udcff" * 240])
def test_long_names(tmp_path, stem):
    path = tmp_path / f"{stem}.exr"
    assert len(os.fsencode(path.name)) > 240
    with renamed_when_whole(path) as temporary:
        Path(temporary).write_text("whole")
    assert path.read_text() == "whole" and list(tmp_path.iterdir()) == [path]


def test_windows_waits_for_who_has_the_file_open(tmp_path, monkeypatch):
    made, path, tried = tmp_path / "made", tmp_path / "picture.png", []
    made.write_bytes(b"new")
    path.write_bytes(b"old")
    replace = Path.replace

    def refused_twice(self, target):
        tried.append(target)
        if len(tried) < 3:
            raise PermissionError(13, "The process cannot access the file")
        return replace(self, target)

    monkeypatch.setattr(Path, "replace", refused_twice)
    with pytest.raises(PermissionError):
        whole_files.replace(made, path)
    tried.clear()
    monkeypatch.setattr(whole_files.sys, "platform", "win32")
    monkeypatch.setattr(whole_files.time, "sleep", lambda seconds: None)
    whole_files.replace(made, path)
    assert path.read_bytes() == b"new" and len(tried) == 3 and not made.exists()
