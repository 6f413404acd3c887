# SPDX-License-Identifier: GPL-3.0-or-later
"""rppm farm as users run it: local workers, real renders, and what is left when something dies."""

import contextlib
import json
import os
import pty
import re
import signal

import distributed
import numpy as np
import pytest

from rppm_addon.commands.picture_files import is_whole
from rppm_addon.pictures import read_exr
from rppm_addon.session.checkpoints.checkpoint_file import read_summary

from .conftest import ROOT, renders_below, rppm_here, start_rppm, started, succeed, wait_for, workers_of


def farm(blend, folder, *options):
    """Arguments of a farm of four frames on two workers."""
    frames = ("--frames", "1..4", "-o", folder / "####.exr", "--samples", 6)
    return "farm", blend, *frames, *(() if "--workers" in options else ("--workers", 2)), *options


def pictures(folder):
    return sorted(folder.glob("*.exr"))


def left_over(folder):
    """Names in the ledger's folder besides the ledger."""
    return [path.name for path in (folder / "####.farm").iterdir() if path.name != "job.json"]


@pytest.mark.long
def test_a_killed_worker_costs_no_frame(tmp_path, rppm, blend_files):
    farmed, single = tmp_path / "farmed", tmp_path / "single.exr"
    with start_rppm(*farm(blend_files[0], farmed, "-o", farmed / "####.png")) as process:
        render = wait_for("a render", lambda: renders_below(process))[0]
        worker = render.parent()
        worker.kill()
        output, errors = process.communicate(timeout=120)
    assert process.returncode == 0, errors
    assert "4 of 4 frames: " in output
    assert len(re.findall(r"^frame \d: \d+\.\d s on \S+:[01]$", output, re.MULTILINE)) == 4
    assert [path.name for path in pictures(farmed)] == [f"000{frame}.exr" for frame in (1, 2, 3, 4)]
    assert all(map(is_whole, [*pictures(farmed), *(path.with_suffix(".png") for path in pictures(farmed))]))
    assert left_over(farmed) == []
    wait_for("the lost worker's render to end", lambda: not render.is_running())

    succeed(rppm, "render", blend_files[0], "--frame", 1, "--samples", 6, "-o", single)
    assert np.array_equal(read_exr(farmed / "0001.exr").combined, read_exr(single).combined)


@pytest.mark.long
def test_a_killed_farm_goes_on_where_it_was(tmp_path, rppm, blend_files):
    with start_rppm(*farm(blend_files[0], tmp_path)) as process:
        wait_for("two frames", lambda: len(pictures(tmp_path)) >= 2)
        renders = renders_below(process)
        process.kill()
        process.communicate(timeout=30)
    wait_for("all renders to end", lambda: not any(render.is_running() for render in renders))
    finished = {path: path.stat().st_mtime_ns for path in pictures(tmp_path)}
    damaged = pictures(tmp_path)[0]
    damaged.write_bytes(damaged.read_bytes()[:-50])
    del finished[damaged]

    output, _ = succeed(rppm, *farm(blend_files[0], tmp_path))
    assert f"{len(finished)} of 4 frames are there and whole" in output
    assert output.count(" s on ") == 4 - len(finished)
    assert len(pictures(tmp_path)) == 4
    assert all(map(is_whole, pictures(tmp_path)))
    assert {path: path.stat().st_mtime_ns for path in finished} == finished
    assert left_over(tmp_path) == []

    status, output, _ = rppm(*farm(blend_files[0], tmp_path))
    assert (status, " s on " in output) == (0, False)


@pytest.mark.long
def test_interrupting_a_farm_leaves_finished_work_only(tmp_path, blend_files):
    with start_rppm(*farm(blend_files[0], tmp_path, "--workers", 1)) as process:
        wait_for("a frame", lambda: pictures(tmp_path))
        render = wait_for("the next frame", lambda: renders_below(process))[0]
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "interrupted" in errors
    assert "Traceback" not in errors
    assert not render.is_running()
    assert 1 <= len(pictures(tmp_path)) < 4
    assert all(map(is_whole, pictures(tmp_path)))
    assert left_over(tmp_path) == []


@pytest.mark.long
def test_a_failing_frame_of_a_chunk_is_told_and_the_others_are_made(tmp_path, rppm, blend_files):
    options = ("-o", tmp_path / "####.exr", "--samples", 2, "--retries", 1, "--chunk", 3)
    status, output, errors = rppm("farm", blend_files[0], "--frames", "4..6", *options)
    assert status == 1
    assert "Traceback" not in errors
    assert re.search(r"rppm: frame 5 failed on \S+: frame 5: .*radius_maximum", errors)
    assert f"rppm render {blend_files[0]} --set rppm.samples=2 --frames 5 -o '{tmp_path}/####.exr'" in errors
    assert "1 of 3 frames failed: frame 5" in errors
    assert [path.name for path in pictures(tmp_path)] == ["0004.exr", "0006.exr"]
    assert all(map(is_whole, pictures(tmp_path)))


def test_a_picture_that_cannot_be_put_in_place_is_told(tmp_path, rppm, blend_files):
    (tmp_path / "0006.exr").mkdir()
    options = ("-o", tmp_path / "####.exr", "--samples", 2, "--retries", 0)
    status, _, errors = rppm("farm", blend_files[0], "--frames", "6", *options)
    assert status == 1
    assert re.search(r"rppm: frame 6 failed on \S+: .*0006.exr", errors)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("a.npz", "--frames", "1..2"), "needs a .blend"),
        (("a.blend", "--frames", "1..2", "--frame", "3"), "--frames alone"),
        (("a.blend", "--parts", "2"), "--samples"),
        (("a.blend", "--frames", "1..2", "--set", "rppm.samples=0"), "samples"),
        (("a.blend", "--frames", "1..2", "--scheduler", "tcp://h:1", "--device", "1"), "RPPM_DEVICE"),
        (("a.blend", "--frames", "1..2"), "does not exist"),
        (("a.blend", "--frames", "1..2", "-o", "all.exr"), "####"),
    ],
)
def test_wrong_calls_are_one_line(tmp_path, arguments, words):
    status, _, errors = rppm_here("farm", *arguments, "-o", tmp_path / "####.exr")
    assert status == 1
    assert words in errors
    assert errors.count("rppm: ") == 1
    assert "Traceback" not in errors


@pytest.mark.long
def test_a_still_in_parts_is_the_still(tmp_path, rppm, saved_scene):
    whole, merged = tmp_path / "whole.exr", tmp_path / "merged.exr"
    succeed(rppm_here, "render", saved_scene, "-o", whole, "--samples", 40)
    still = ("farm", saved_scene, "--samples", 40, "--parts", 3, "-o", merged, "-o", tmp_path / "merged.png")
    output, _ = succeed(rppm, *still, "--workers", 2)
    assert output.count(" s on ") == 4  # three parts and the merge
    single, farmed = read_exr(whole), read_exr(merged)
    assert farmed.metadata["iterations"] == "40"
    assert farmed.metadata["photons"] == single.metadata["photons"]
    np.testing.assert_allclose(farmed.combined, single.combined, rtol=1e-6, atol=1e-7)
    assert is_whole(tmp_path / "merged.png")
    assert [path.name for path in (tmp_path / "merged.farm").iterdir()] == ["job.json"]

    status, output, _ = rppm_here(*still)
    assert (status, " s on " in output) == (0, False)
    status, _, errors = rppm_here(*still[:4], "--parts", 4, "-o", merged)
    assert status == 1
    assert "other parts" in errors


@pytest.mark.long
def test_an_interrupted_part_goes_on_from_its_checkpoint(tmp_path, rppm, saved_scene, monkeypatch):
    monkeypatch.setenv("COLUMNS", "200")
    whole, merged, folder = tmp_path / "whole.exr", tmp_path / "merged.exr", tmp_path / "merged.farm"
    still = ("farm", saved_scene, "--samples", 1200, "--parts", 1, "-o", merged)
    ours, theirs = pty.openpty()  # on a terminal progress is told at once
    with start_rppm(*still, errors=theirs) as process, open(ours, errors="replace", newline="") as terminal:
        os.close(theirs)
        told = ""
        while not re.search(r"samples 0 to 1199 on \S+ [1-9]\d?%", told):
            told = told[-200:] + terminal.read(1)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
    assert process.returncode == 130
    assert [path.name for path in folder.glob("samples_*")] == ["samples_0_1200.checkpoint.exr"]
    begun = read_summary(folder / "samples_0_1200.checkpoint.exr").iteration
    assert 0 < begun < 1200

    output, _ = succeed(rppm, *still)
    assert output.count(" s on ") == 2
    succeed(rppm, "render", saved_scene, "-o", whole, "--samples", 1200)
    np.testing.assert_allclose(read_exr(merged).combined, read_exr(whole).combined, rtol=1e-6, atol=1e-7)


@pytest.mark.long
def test_a_task_that_loses_too_many_workers_is_given_up(tmp_path, blend_files):
    frames = ("--frames", "1..2", "--samples", 6, "-o", tmp_path / "####.exr")
    with start_rppm("farm", blend_files[0], *frames, "--retries", 1) as process:
        lost = None
        for _ in range(2):
            # A render takes a moment to end with its worker, and may outlive the next one.
            renders = wait_for("frame 1", lambda known=lost: {*renders_below(process, "--frames 1 ")} - {known})
            lost = renders.pop()
            lost.parent().kill()
        output, errors = process.communicate(timeout=120)
    assert process.returncode == 1
    assert "rppm: frame 1 failed: its worker was lost 2 times" in errors
    assert "1 of 2 frames failed: frame 1" in errors
    assert output.count(" s on ") == 1
    assert [path.name for path in pictures(tmp_path)] == ["0002.exr"]


@pytest.mark.long
def test_a_worker_that_dies_while_it_starts_is_replaced(tmp_path, blend_files):
    """Dask alone may not start it again."""
    frames = ("--frames", "1..2", "--samples", 6, "-o", tmp_path / "####.exr")
    with start_rppm("farm", blend_files[0], *frames) as process:
        worker = wait_for("a render", lambda: renders_below(process))[0].parent()
        worker.kill()
        successor = wait_for("its successor", lambda: [found for found in workers_of(process) if found != worker])[0]
        successor.kill()
        output, errors = process.communicate(timeout=150)
    assert process.returncode == 0, errors
    assert output.count(" s on ") == 2
    assert len(pictures(tmp_path)) == 2


@pytest.mark.long
def test_workers_of_a_scheduler_need_the_same_rppm(tmp_path, blend_files):
    """By the commands of docs/farm.md; the scheduler and one worker have none."""
    other = tmp_path / "other"
    other.mkdir()
    (other / "rppm_addon.py").write_text("raise ImportError('no RPPM here')")
    scheduler = ["scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard"]
    scheduler += ["--scheduler-file", str(tmp_path / "scheduler.json")]
    with contextlib.ExitStack() as stack:
        stack.enter_context(started(["dask", *scheduler], other, PYTHONPATH=str(other)))
        wait_for("the scheduler", (tmp_path / "scheduler.json").exists)
        address = json.loads((tmp_path / "scheduler.json").read_text())["address"]
        worker = ("worker", address, "--nthreads", "1", "--nworkers", "1", "--no-dashboard", "--name")
        for name, folder in (("same", ROOT), ("other", other)):
            stack.enter_context(started(["dask", *worker, name], folder, PYTHONPATH=str(folder)))
        with distributed.Client(address) as client:
            wait_for("both workers", lambda: len(client.scheduler_info()["workers"]) == 2)
        farm = ("farm", blend_files[0], "--frames", "1..2", "--scheduler", address)
        with start_rppm(*farm, "--samples", 2, "-o", tmp_path / "####.exr") as process:
            output, errors = process.communicate(timeout=120)
        assert process.returncode == 0, errors
        assert re.search(r"workers must run the same RPPM .* left out: tcp\S+: no RPPM here", errors)
        assert len(re.findall(r"^frame \d: \d+\.\d s on \S+:same$", output, re.MULTILINE)) == 2
        assert all(map(is_whole, pictures(tmp_path)))

        with start_rppm(*farm, "--overwrite", "--seconds", 600, "-o", tmp_path / "####.exr") as process:
            attempt = wait_for("a render", lambda: list((tmp_path / "####.farm").glob("attempt_*")))[0]
            process.kill()
        wait_for("the render to end", lambda: not attempt.exists())
    with start_rppm(*farm, "--overwrite", "-o", tmp_path / "####.exr") as process:
        _, errors = process.communicate(timeout=120)
    assert process.returncode == 1
    assert "dask scheduler" in errors
