# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders that are interrupted and gone on with, and stills rendered in parts."""

import dataclasses
import json
import signal

import numpy as np
import PIL.Image
import pytest
from cli.conftest import interrupt, rppm_here, start_rppm, succeed
from support.floor import floor_scene
from support.render_states import assert_same_state

from rppm_addon.integrator.common.iteration import LEARNING_ITERATIONS
from rppm_addon.pictures import read_exr
from rppm_addon.scene import Instance, Shutter, save_scene
from rppm_addon.session.checkpoints.checkpoint_file import read_checkpoint, read_summary

LAST = LEARNING_ITERATIONS + 3


@pytest.fixture(scope="module")
def two_floors(tmp_path_factory):
    """The floor, another above it that sends light back, and a light of less use far away, as a .npz."""
    scene = floor_scene()
    above = np.diag([1.0, -1.0, -1.0, 1.0])
    above[2, 3] = 4.5
    scene.instances.append(Instance(0, above, [0], "Ceiling"))
    far = scene.lights[0].matrix.copy()
    far[0, 3] = -8.0
    scene.lights.append(dataclasses.replace(scene.lights[0], name="Far", matrix=far))
    path = tmp_path_factory.mktemp("scene") / "floors.npz"
    save_scene(scene, path)
    return path


@pytest.fixture(scope="module")
def uninterrupted(two_floors):
    """The checkpoint at the end of a render without a stop."""
    path = two_floors.with_name("whole.exr")
    render(two_floors, path, LAST)
    return read_checkpoint(path)


def render(scene, checkpoint, iterations, *more, run=rppm_here):
    """Render to so many iterations; returns what the program said on standard error."""
    picture = checkpoint.with_name("picture.exr")
    command = ["render", scene, "-o", picture, "--checkpoint", checkpoint, "--samples", iterations, *more]
    status, _, errors = run(*command)
    assert (status, "Traceback" in errors) == (0, False), errors
    return errors


def test_a_resumed_render_is_the_uninterrupted_one(tmp_path, two_floors, uninterrupted):
    """Stopped while photons are learned of, right after that, and once it is over."""
    checkpoint = tmp_path / "still.exr"
    errors = render(two_floors, checkpoint, 1, "--resume")
    assert "not there yet: the render starts from the beginning" in errors
    for stop in (4, LEARNING_ITERATIONS + 1, LAST):
        report = tmp_path / "report.json"
        before = read_summary(checkpoint)
        render(two_floors, checkpoint, stop, "--resume", "--json", report)
        told = json.loads(report.read_text())
        assert told["resumed_iterations"] == before.iteration
        assert told["statistics"]["iterations"] == stop
        assert told["statistics"]["photons"] == stop * 1024
    summary, pause = read_checkpoint(checkpoint)
    assert_same_state(pause.state, uninterrupted[1].state)
    assert summary.render == uninterrupted[0].render
    assert summary.seconds > before.seconds
    picture = read_exr(tmp_path / "picture.exr")
    np.testing.assert_array_equal(picture.combined, pause.state.radiance)
    # There is nothing left to do: the picture is written all the same.
    (tmp_path / "picture.exr").unlink()
    render(two_floors, checkpoint, LAST, "--resume")
    np.testing.assert_array_equal(read_exr(tmp_path / "picture.exr").combined, picture.combined)


@pytest.mark.parametrize("number", [pytest.param(signal.SIGTERM, marks=pytest.mark.long), signal.SIGKILL])
def test_a_render_that_a_signal_ends_is_gone_on_with(tmp_path, rppm, two_floors, uninterrupted, number):
    """By another process."""
    checkpoint, picture = tmp_path / "still.exr", tmp_path / "out.exr"
    arguments = ["-o", picture, "--checkpoint", checkpoint, "--checkpoint-minutes", 0]
    with start_rppm("render", two_floors, *arguments, "--seconds", 90) as process:
        errors = interrupt(process, number, checkpoint.exists)
    stopped = read_summary(checkpoint).iteration
    if number == signal.SIGTERM:
        assert process.returncode == 128 + signal.SIGTERM
        assert "go on with --resume" in errors
        assert int(read_exr(picture).metadata["iterations"]) == stopped
    if stopped <= LAST:
        render(two_floors, checkpoint, LAST, "--resume", run=rppm)
        assert_same_state(read_checkpoint(checkpoint)[1].state, uninterrupted[1].state)


def test_what_cannot_be_gone_on_with_is_refused(tmp_path, two_floors, saved_scene):
    checkpoint, picture = tmp_path / "still.exr", tmp_path / "picture.exr"
    render(two_floors, checkpoint, 2)

    def refusal(scene, *more):
        status, _, errors = rppm_here("render", scene, "-o", picture, *more)
        assert (status, errors.count("\n") <= 2) == (1, True), errors
        return errors

    again = ("--checkpoint", checkpoint, "--samples", 3)
    before = checkpoint.read_bytes()
    assert "is there already; go on from it with --resume" in refusal(two_floors, *again)
    assert "of another scene than this render (other instances, lights)" in refusal(saved_scene, *again, "--resume")
    assert "(other camera)" in refusal(two_floors, *again, "--resume", "--resolution", "8x8")
    settings = refusal(two_floors, *again, "--resume", "--photons", 999, "--set", "rppm.alpha=0.6")
    assert "(photons 1024 instead of 999, alpha 0.7 instead of 0.6)" in settings
    fewer = refusal(two_floors, "--checkpoint", checkpoint, "--samples", 1, "--resume")
    assert "has 2 samples already" in fewer
    assert checkpoint.read_bytes() == before
    checkpoint.write_bytes(before[:-100])
    assert "was cut short" in refusal(two_floors, *again, "--resume")
    assert "--resume needs a checkpoint" in refusal(two_floors, "--resume")
    assert "both name" in refusal(two_floors, "--checkpoint", picture, "--samples", 3)


def test_parts_merge_into_the_picture_of_one_run(tmp_path, two_floors, uninterrupted):
    """The first part ends while photons are learned of, the last one begins after that; a checkpoint is a part too."""
    ranges = [(0, 5), (5, 18), (18, LAST)]
    parts = [tmp_path / f"part_{first}.exr" for first, _ in ranges]
    for (first, end), part in zip(ranges, parts):
        output, _ = succeed(rppm_here, "render", two_floors, "--samples-range", f"{first}:{end}", "-o", part)
        assert f"{end - first} samples" in output and str(part) in output
    merged = tmp_path / "merged.exr"
    output, _ = succeed(rppm_here, "merge", *reversed(parts), "-o", merged, "-o", tmp_path / "merged.png")
    assert f"{LAST} samples, 19.5 k photons of 3 parts" in output
    state, picture = uninterrupted[1].state, read_exr(merged)
    np.testing.assert_allclose(picture.combined, state.radiance, rtol=1e-6, atol=1e-30)
    np.testing.assert_allclose(picture.layer("Normal"), state.passes["Normal"], rtol=1e-6, atol=1e-6)
    np.testing.assert_array_equal(picture.layer("Depth"), state.passes["Depth"])
    assert picture.metadata["iterations"] == str(LAST)
    status, _, errors = rppm_here("merge", parts[0], parts[2], "-o", merged)
    assert status == 1
    assert "samples 5:18 are in no part" in errors


def test_a_part_is_kept_and_gone_on_with_too(tmp_path, two_floors, uninterrupted):
    """The part is its own checkpoint."""
    part = tmp_path / "part.exr"
    keep = ("-o", part, "--checkpoint", part, "--resume")
    for end in (19, LAST + 1):
        succeed(rppm_here, "render", two_floors, "--samples-range", f"18:{end}", *keep)
    summary, pause = read_checkpoint(part)
    assert (summary.sample_offset, summary.iteration) == (18, LAST + 1)
    np.testing.assert_array_equal(pause.state.tallies, uninterrupted[1].state.tallies)
    status, _, errors = rppm_here("render", two_floors, "-o", tmp_path / "a.exr", "--checkpoint", part, "--resume")
    assert status == 1
    assert "go on with --samples-range 18:B" in errors


def test_ranges_that_make_no_sense(tmp_path, two_floors):
    for text in ("5:5", "a:b"):
        status, _, errors = rppm_here("render", two_floors, "-o", tmp_path / "a.exr", f"--samples-range={text}")
        assert (status, "is not a range of samples" in errors) == (2, True)
    for outputs in (["-o", tmp_path / "a.png"], ["-o", tmp_path / "a.exr", "-o", tmp_path / "b.exr"]):
        status, _, errors = rppm_here("render", two_floors, *outputs, "--samples-range", "0:2")
        assert (status, "give one -o PART.exr" in errors) == (1, True)


def test_a_rolling_shutter_is_rendered_as_a_whole(tmp_path):
    """Its rows are exposed in different samples, which merging would take for those of all rows."""
    scene, path = floor_scene(), tmp_path / "rolling.npz"
    scene.shutter = Shutter(np.ones(4), rolling_duration=0.1)
    save_scene(scene, path)
    command = ["render", path, "-o", tmp_path / "picture.exr"]
    status, _, errors = rppm_here(*command, "--samples-range", "0:2")
    assert (status, "render it as a whole, or set Rolling Shutter to None" in errors) == (1, True)
    assert rppm_here(*command, "--samples", 2)[0] == 0


@pytest.mark.long
def test_stills_of_a_blend_file(tmp_path, rppm, blend_files):
    """Checkpoints are written in Blender's own render; what is merged has the scene's view, bit for bit."""
    view = ("--set", "view_settings.view_transform=AgX", "--set", "view_settings.exposure=1.5", "--frame", 1)
    checkpoint = tmp_path / "still.exr"
    exr, png = tmp_path / "out.exr", tmp_path / "out.png"
    for more in (("--samples", 2), ("--samples", 4, "--resume")):
        succeed(rppm, "render", blend_files[0], *view, "-o", exr, "-o", png, "--checkpoint", checkpoint, *more)
    part = tmp_path / "part.exr"
    succeed(rppm, "render", blend_files[0], *view, "-o", part, "--samples-range", "0:4")
    assert_same_state(read_checkpoint(part)[1].state, read_checkpoint(checkpoint)[1].state)
    merged_exr, merged_png = tmp_path / "merged.exr", tmp_path / "merged.png"
    status, _, errors = rppm("merge", part, "-o", merged_exr, "-o", merged_png)  # opens the .blend file
    assert status == 0, errors
    for name, channel in read_exr(exr).channels.items():
        np.testing.assert_array_equal(channel, read_exr(merged_exr).channels[name], name)
    assert pixels(merged_png).std() > 5
    np.testing.assert_array_equal(pixels(merged_png), pixels(png))


def pixels(path):
    with PIL.Image.open(path) as image:
        return np.asarray(image)
