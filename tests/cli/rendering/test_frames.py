# SPDX-License-Identifier: GPL-3.0-or-later
"""rppm render --frames: which frames, where they go, and what is left when something goes wrong."""

import json
import signal
from pathlib import Path

import numpy as np
import pytest
from cli.conftest import interrupt, rppm_here, start_rppm, succeed

from rppm_addon.commands.options.frame_numbers import frame_numbers, path_of_frame
from rppm_addon.pictures import read_exr
from rppm_addon.scene.errors import SettingsError


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("7", (7,)), ("1..4", (1, 2, 3, 4)), ("1..10..4", (1, 5, 9)), ("9, 5,1", (9, 5, 1)),
        ("-2..0,8..9", (-2, -1, 0, 8, 9)),
    ],
)  # fmt: skip
def test_frame_numbers(text, expected):
    assert frame_numbers(text) == expected


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("", "names no frames"), ("1..", "names no frames"), ("1-5", "names no frames"), ("1.5", "names no frames"),
        ("1..2..3..4", "names no frames"), ("5..1", "write 1..5"), ("1..5..0", "step of 0"), ("1..5..-1", "step of -1"),
        ("1..3,2", "frame 2 is named twice"), ("1..99999999", "beyond Blender's frames"),
    ],
)  # fmt: skip
def test_wrong_frame_numbers(text, why):
    with pytest.raises(SettingsError, match=why):
        frame_numbers(text)


@pytest.mark.parametrize(
    ("name", "frame", "expected"),
    [
        ("out_####.exr", 7, "out_0007.exr"),
        ("#.exr", 123, "123.exr"),
        ("a#b##.png", 5, "a#b05.png"),
        ("out_####.exr", -7, "out_-0007.exr"),
        ("out.exr", 7, "out.exr"),
    ],
)
def test_names_of_frames(name, frame, expected):
    assert path_of_frame(Path("in#folder") / name, frame) == Path("in#folder") / expected


@pytest.mark.parametrize(
    ("arguments", "status", "why"),
    [
        (("floor.blend", "--frames", "5..1", "-o", "out_#.exr"), 2, "write 1..5"),
        (("floor.blend", "--frames", "1..3", "-o", "out.exr"), 1, "-o out_####.exr"),
        (("floor.blend", "--frames", "1..3", "-o", "out_#.exr", "-o", "out.png"), 1, "-o out_####.png"),
        (("floor.blend", "--frames", "1..3", "--frame", "1", "-o", "out_#.exr"), 1, "leave one out"),
        (("floor.blend", "--frames", "1..3", "--checkpoint", "c.exr", "-o", "out_#.exr"), 1, "are for stills"),
        (("floor.blend", "--frames", "1..3", "--samples-range", "0:2", "-o", "o#.exr"), 1, "are for stills"),
        (("floor.npz", "--frames", "1..3", "-o", "out_#.exr"), 1, "needs a .blend file"),
        (("floor.blend", "-o", "out_####.exr"), 1, "say which frame"),
    ],
)
def test_arguments_that_do_not_go_together(tmp_path, monkeypatch, arguments, status, why):
    monkeypatch.chdir(Path(__file__).resolve().parents[3])
    arguments = [str(tmp_path / item) if "." in item and ".." not in item else item for item in arguments]
    found, output, errors = rppm_here("render", *arguments)
    assert (found, errors.count("\n"), "Traceback" in errors) == (status, 1, False), errors
    assert why in errors.replace(f"{tmp_path}/", "")
    assert not any(tmp_path.iterdir())


def arrays(path):
    channels = read_exr(path).channels
    return {name: channels[name].tobytes() for name in sorted(channels)}


@pytest.mark.long
def test_frames_are_those_of_single_renders(tmp_path, rppm, blend_files):
    """One start for all; a broken frame is told and left out; --resume renders what is missing."""
    exr, png, report = tmp_path / "new" / "out_##.exr", tmp_path / "out_####.png", tmp_path / "report.json"
    arguments = ("render", blend_files[0], "--frames", "1..2,5,7", "-o", exr, "-o", png, "--json", report)
    status, output, errors = rppm(*arguments)
    assert (status, "Traceback" in errors) == (1, False), errors
    assert "rppm: frame 5: radius_maximum is 1.0" in errors and "could not be rendered: 5" in errors
    assert "0% frame 1 (1 of 4), " in errors
    assert [line.split(":")[0] for line in output.splitlines()] == ["Frame 1", "Frame 2", "Frame 7"]
    assert sorted(path.name for path in exr.parent.iterdir()) == ["out_01.exr", "out_02.exr", "out_07.exr"]
    assert sorted(path.name for path in tmp_path.glob("*.png")) == ["out_0001.png", "out_0002.png", "out_0007.png"]

    told = json.loads(report.read_text())
    assert [entry["frame"] for entry in told["frames"]] == [1, 2, 5, 7]
    assert "radius_maximum" in told["frames"][2]["error"]
    assert told["blender"]["load_seconds"] > 0.0 and told["frames"][3]["export_seconds"] > 0.0
    assert told["frames"][3]["statistics"]["iterations"] == 3
    assert told["frames"][3]["files"] == [str(exr.parent / "out_07.exr"), str(tmp_path / "out_0007.png")]

    # Frame 2 comes after frame 1 and is as if there had been none; the file's name has a place for its number.
    succeed(rppm, "render", blend_files[0], "--frame", 2, "-o", tmp_path / "single_###.exr")
    expected = arrays(tmp_path / "single_002.exr")
    assert arrays(exr.parent / "out_02.exr") == expected
    assert arrays(exr.parent / "out_01.exr") != expected

    written = {path: path.stat().st_mtime_ns for path in exr.parent.iterdir()}
    (tmp_path / "out_0002.png").unlink()
    seeds = ("--set", "rppm.use_animated_seed=true", "--set", "rppm.seed=5")
    output, _ = succeed(rppm, *arguments[:3], "1..2,7", *arguments[4:], "--resume", *seeds)
    assert output.splitlines()[0] == "2 of 3 frames are there already" and "Frame 2: " in output
    now = {path: path.stat().st_mtime_ns for path in exr.parent.iterdir()}
    assert [path.name for path in now if now[path] != written[path]] == ["out_02.exr"]
    assert arrays(exr.parent / "out_02.exr") != expected
    told = json.loads(report.read_text())
    assert [entry.get("skipped", False) for entry in told["frames"]] == [True, True, False]
    assert told["frames"][2]["settings"]["seed"] not in (0, 5)

    status, output, _ = rppm(*arguments[:3], "1..2,7", *arguments[4:], "--resume")
    assert (status, output) == (0, "3 of 3 frames are there already\n")


@pytest.mark.parametrize(
    ("number", "expected"),
    [(signal.SIGINT, 130), pytest.param(signal.SIGTERM, 143, marks=pytest.mark.long), (signal.SIGKILL, -9)],
)
def test_whoever_ends_it_leaves_whole_files(tmp_path, blend_files, number, expected):
    frames = tmp_path / "out_####.exr"
    arguments = ("render", blend_files[0], "--frames", "6..4000", "--samples", 20, "-o", frames)
    with start_rppm(*arguments) as process:
        errors = interrupt(process, number, lambda: len(list(tmp_path.glob("out_*.exr"))) > 2)
    assert process.returncode == expected
    found = sorted(tmp_path.glob("out_*.exr"))
    assert len(found) >= 3
    for path in found:
        picture = read_exr(path)
        assert picture.metadata["iterations"] == "20"
        assert np.isfinite(picture.combined).all()
    if number != signal.SIGKILL:  # whoever is killed may leave the file that he was at, under another name
        assert set(tmp_path.iterdir()) == set(found)
        assert "go on with --resume" in errors
