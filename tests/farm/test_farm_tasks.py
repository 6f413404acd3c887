# SPDX-License-Identifier: GPL-3.0-or-later
"""Tasks that a farm hands out, and how it knows which are done."""

import dataclasses
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from rppm_addon.commands.farm.errors import FarmError
from rppm_addon.commands.farm.ledger import Ledger
from rppm_addon.commands.farm.tasks import Task, chunks, frame_tasks, still_tasks
from rppm_addon.commands.farm.worker import put_in_place
from rppm_addon.commands.picture_files import is_whole, write_png
from rppm_addon.pictures import write_exr
from rppm_addon.scene.errors import SettingsError

JOB = {"scene": ["/a.blend", 1, 2], "options": ["--samples", "4"], "split": None, "RPPM": "0.1.0+12345678"}


def write_picture(path):
    pixels = np.random.default_rng(1).random((9, 7, 4), np.float32)
    if path.suffix == ".exr":
        write_exr(path, pixels, {"Depth": pixels[..., 0]})
    else:
        write_png(path, (pixels * 255).astype(np.uint8))


def test_files_of_further_layers_come_along(tmp_path):
    attempt, out = tmp_path / "attempt", tmp_path / "out"
    attempt.mkdir()
    out.mkdir()
    for name in ("0001.png", "0001_Fog.png", "0001.exr", ".0001.half.png", "other_Fog.png"):
        (attempt / name).touch()
    put_in_place(Task((), (out / "####.png", out / "####.exr"), (1, 2)), attempt)
    assert {path.name for path in out.iterdir()} == {"0001.png", "0001_Fog.png", "0001.exr"}


def test_frames_are_calls_of_rppm_render():
    outputs = [Path("/out/x_####.exr"), Path("/out/x_##.png")]
    tasks = frame_tasks(Path("/in/a b.blend"), (7, 8, 10), outputs, ["--photons", "5"])
    assert tasks[0].files == (Path("/out/x_0007.exr"), Path("/out/x_07.png"))
    assert tasks[0].command_line == (
        "rppm render '/in/a b.blend' --photons 5 --frames 7 -o '/out/x_####.exr' -o '/out/x_##.png'"
    )
    assert [task.name for task in tasks] == ["frame 7", "frame 8", "frame 10"]
    pair, rest = chunks(tasks, 2)
    assert (pair.name, rest) == ("frames 7, 8", tasks[2])
    assert pair.files == tasks[0].files + tasks[1].files
    assert pair.command([Path("#.exr")])[-4:] == ["--frames", "7,8", "-o", "#.exr"]


def test_what_is_done_of_a_chunk_is_left_out(tmp_path):
    (chunk,) = chunks(frame_tasks(Path("/a.blend"), (1, 2, 3), [tmp_path / "#.exr"], []), 5)
    assert chunk.rest == chunk
    write_picture(tmp_path / "2.exr")
    assert chunk.rest.frames == (1, 3)
    assert [single.frames for single in chunk.rest.singles] == [(1,), (3,)]


FOLDER = Path("/out/x.farm")
GOOD = Task(("render", "/in/a.blend", "--set", "rppm.alpha=0.5"), (Path("/out/####.exr"), Path("/out/#.png")), (7, 8))


def test_tasks_that_the_farm_makes_are_let_in():
    GOOD.check(FOLDER)
    tasks, merge = still_tasks(Path("/a.npz"), 9, 3, [Path("/out/x.exr")], FOLDER, ["--photons", "5"])
    for task in (*tasks, merge):
        task.check(FOLDER)


@pytest.mark.parametrize(
    "change",
    [
        {"outputs": (Path("/out/../etc/####.exr"),)}, {"outputs": (Path("/out/.."),)}, {"outputs": (Path("####.exr"),)},
        {"outputs": ()}, {"outputs": (Path("/out/####.sh"),)}, {"outputs": (Path("/a/#.exr"), Path("/b/#.exr"))},
        {"outputs": ("/out/####.exr",)}, {"outputs": [Path("/out/####.exr")]}, {"frames": ("7",)}, {"frames": (1.5,)},
        {"arguments": ("export", "/in/a.blend")}, {"arguments": ()}, {"arguments": ("render",)}, {"arguments": (5,)},
        {"arguments": ("render", "/in/a.blend", "-o", "/etc/x.exr")}, {"words": None},
        {"arguments": ("render", "/in/a.blend", "--outp=/etc/x.exr")}, {"arguments": ("render", "--help")},
        {"arguments": ("render", "/in/a.blend", "--js", "/etc/x")}, {"arguments": ("info", "--json", "/etc/x")},
        {"arguments": ("render", "/in/a.npz", "--checkp", "/etc/c.exr"), "frames": ()},
    ],
    ids=str,
)  # fmt: skip
def test_tasks_of_somebody_else_are_refused(change):
    with pytest.raises(SettingsError):
        dataclasses.replace(GOOD, **change).check(FOLDER)


def test_a_ledger_that_is_elsewhere_is_refused():
    for folder in (Path("farm"), Path("/out/../x.farm")):
        with pytest.raises(SettingsError, match=r"without \.\."):
            GOOD.check(folder)


@pytest.mark.parametrize(("iterations", "parts"), [(4000, 7), (5, 5), (9, 1)])
def test_parts_are_all_iterations_once(iterations, parts):
    outputs = [Path("/o.exr"), Path("/o.png")]
    tasks, merge = still_tasks(Path("/a.npz"), iterations, parts, outputs, Path("/o.farm"), ["--photons", "5"])
    ranges = [tuple(map(int, task.arguments[3].split(":"))) for task in tasks]
    assert [task.arguments[:3] for task in tasks] == [("render", "/a.npz", "--samples-range")] * parts
    assert [iteration for first, end in ranges for iteration in range(first, end)] == list(range(iterations))
    assert max(end - first for first, end in ranges) - min(end - first for first, end in ranges) <= 1
    files = [str(task.outputs[0]) for task in tasks]
    assert len({*files, *(task.arguments[5] for task in tasks)}) == 2 * parts  # parts and checkpoints
    assert merge.command(merge.outputs) == ["merge", *files, "-o", "/o.exr", "-o", "/o.png"]


def test_more_parts_than_iterations_are_refused():
    with pytest.raises(SettingsError, match="fewer"):
        still_tasks(Path("/a.npz"), 3, 4, [Path("/o.exr")], Path("/o.farm"), [])


@pytest.mark.parametrize("suffix", [".exr", ".png"])
def test_only_undamaged_pictures_are_whole(tmp_path, suffix):
    path = tmp_path / f"picture{suffix}"
    assert not is_whole(path)
    write_picture(path)
    assert is_whole(path)
    data = path.read_bytes()
    for length in (0, 5, 40, len(data) // 2, len(data) - 1):
        path.write_bytes(data[:length])
        assert not is_whole(path), length
    path.write_bytes(data[: len(data) // 2] + bytes(8) + data[len(data) // 2 + 8 :])
    assert not is_whole(path)


def test_pictures_of_pillow_and_blender_are_whole(tmp_path):
    pillow = pytest.importorskip("PIL.Image")
    pillow.fromarray(np.zeros((5, 3, 3), np.uint8)).save(tmp_path / "rgb.png")
    pillow.fromarray(np.zeros((5, 3), bool)).save(tmp_path / "bits.png")
    assert is_whole(tmp_path / "rgb.png")
    assert is_whole(tmp_path / "bits.png")


def test_the_ledger_leaves_what_is_whole_and_makes_anew_what_is_not(tmp_path):
    tasks = [Task(("render",), (tmp_path / f"{frame}.exr",)) for frame in range(3)]
    ledger = Ledger(tmp_path / "#.exr")
    assert ledger.open(JOB, tasks, overwrite=False) == tasks
    write_picture(tasks[0].outputs[0])
    write_picture(tasks[1].outputs[0])
    tasks[1].outputs[0].write_bytes(tasks[1].outputs[0].read_bytes()[:-9])
    (ledger.folder / "attempt_lost").mkdir()
    assert Ledger(tmp_path / "#.exr").open(JOB, tasks, overwrite=False) == tasks[1:]
    assert [path.name for path in ledger.folder.iterdir()] == ["job.json"]
    assert ledger.open(JOB, tasks, overwrite=True) == tasks
    assert not tasks[0].outputs[0].exists()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"scene": ["/a.blend", 1, 3]}, "saved again"),
        ({"options": []}, "other options"),
        ({"split": [4, 2]}, "other parts"),
        ({"RPPM": "0.2.0+12345678"}, "another RPPM"),
    ],
)
def test_the_ledger_never_mixes_pictures_of_two_jobs(tmp_path, change, words):
    task = Task(("render",), (tmp_path / "1.exr",))
    ledger = Ledger(tmp_path / "#.exr")
    ledger.open(JOB, [task], overwrite=False)
    assert ledger.open(JOB | change, [task], overwrite=False) == [task]  # nothing is there yet
    write_picture(task.outputs[0])
    with pytest.raises(FarmError, match=f"{words}; add --overwrite"):
        ledger.open(JOB, [task], overwrite=False)
    assert ledger.open(JOB, [task], overwrite=True) == [task]


def test_pictures_of_unknown_origin_are_left_alone(tmp_path):
    task = Task(("render",), (tmp_path / "1.exr",))
    write_picture(task.outputs[0])
    with pytest.raises(FarmError, match="does not record"):
        Ledger(tmp_path / "#.exr").open(JOB, [task], overwrite=False)
    assert is_whole(task.outputs[0])


def test_the_ledger_is_readable_json(tmp_path):
    ledger = Ledger(tmp_path / "#.exr")
    ledger.open(JOB, [], overwrite=False)
    assert json.loads((ledger.folder / "job.json").read_text()) == JOB


def test_without_dask_the_farm_names_the_remedy():
    code = (
        "import sys; sys.modules['distributed'] = None; from rppm_addon.cli import main; sys.exit(main(sys.argv[1:]))"
    )
    run = subprocess.run(
        [sys.executable, "-c", code, "farm", "a.blend", "--frames", "1..2", "-o", "#.exr"],
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert run.returncode == 1
    assert "pip install -e '.[farm]'" in run.stderr
    assert run.stderr.count("\n") == 1
