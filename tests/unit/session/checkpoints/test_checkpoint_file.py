# SPDX-License-Identifier: GPL-3.0-or-later
"""Checkpoint files: what was written comes back bit for bit, and nothing else does."""

import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from support import checkpoints
from support.full_scene import full_scene
from support.render_states import assert_same_arrays, assert_same_state

from rppm_addon.pictures import PictureError, read_exr
from rppm_addon.scene.errors import CheckpointError
from rppm_addon.session.checkpoints.checkpoint_file import FORMAT, read_checkpoint, read_summary, write_checkpoint
from rppm_addon.session.checkpoints.checkpoint_writer import still_render


@pytest.mark.parametrize("learned", [False, True])
def test_what_is_written_is_read_bit_for_bit(tmp_path, learned):
    path = tmp_path / "new" / "still.exr"
    render, pause = checkpoints.still_render(source={"blend": {"path": "a.blend"}}), checkpoints.pause(3, 9, learned)
    render.settings["passes"] = ["Depth", "Normal", "Deep Cubemap"]
    state = pause.state
    state.radiance[0, :4] = [[np.nan, np.inf, -np.inf, -0.0]] * 4
    state.radiance.view(np.uint32)[1, 0, 0] = 0x7FC12345  # what a NaN carries comes back as well
    state.pass_counts[0, 0, 0], state.tallies[0, 0] = 0xFFFFFFFF, 0xFFFFFFFE
    state.wide_radius = np.nextafter(0.1, 1.0)
    pause.inspections["Deep Cubemap"] = np.random.default_rng(1).random((*state.radiance.shape[:2], 3), np.float32)
    write_checkpoint(path, render, pause, 12.5)
    summary, found = read_checkpoint(path)
    assert summary == read_summary(path)
    assert (summary.render, summary.seconds, summary.photons) == (render, 12.5, 6 * 60)
    assert (found.device, found.radius_meters) == (pause.device, pause.radius_meters)
    assert_same_arrays(pause.inspections, found.inspections)
    assert_same_state(state, found.state)
    arrays = [value for value in vars(found.state).values() if isinstance(value, np.ndarray)]
    assert all(array.flags.c_contiguous for array in arrays)


def test_any_viewer_shows_the_picture(tmp_path):
    path = checkpoints.write_part(tmp_path / "still.exr", 0, 5)
    picture, state = read_exr(path), checkpoints.pause(0, 5).state
    np.testing.assert_array_equal(picture.combined, state.radiance)
    np.testing.assert_array_equal(picture.layer("Normal"), state.passes["Normal"])
    np.testing.assert_array_equal(picture.layer("Depth"), state.passes["Depth"])
    assert picture.placement == checkpoints.still_render().placement


def damaged(whole: bytes, generator: random.Random) -> bytes:
    """Cut short, with single bytes changed, or with bytes put in or left out."""
    data = bytearray(whole)
    kind = generator.randrange(3)
    if kind == 0:
        return bytes(data[: generator.randrange(len(data))])
    if kind == 1:
        place = generator.randrange(len(data))
        data[place] ^= 1 << generator.randrange(8)
        return bytes(data)
    start, end = sorted(generator.randrange(len(data)) for _ in range(2))
    data[start:end] = generator.randbytes(generator.randrange(1, 50))
    return bytes(data)


def test_damaged_files_are_refused(tmp_path):
    path = checkpoints.write_part(tmp_path / "still.exr", 0, 5)
    whole = path.read_bytes()
    generator = random.Random(7)
    for _ in range(150):
        data = damaged(whole, generator)
        if data == whole:
            continue
        path.write_bytes(data)
        for read in (read_summary, read_checkpoint):
            with pytest.raises(CheckpointError, match="no checkpoint|damaged"):
                read(path)


def test_what_is_no_checkpoint_is_refused(tmp_path):
    path = tmp_path / "still.exr"
    with pytest.raises(CheckpointError, match="does not exist"):
        read_summary(path)
    path.write_bytes(b"")
    with pytest.raises(CheckpointError, match="no checkpoint"):
        read_summary(path)
    path.write_bytes(checkpoints.signed(b"not a picture at all"))
    with pytest.raises(CheckpointError, match="cannot be read"):
        read_summary(path)
    whole = checkpoints.unsigned(checkpoints.write_part(path, 0, 5).read_bytes())
    path.write_bytes(checkpoints.signed(whole.replace(f'"format": {FORMAT}'.encode(), b'"format": 9')))
    with pytest.raises(CheckpointError, match="another version"):
        read_checkpoint(path)
    path.write_bytes(checkpoints.signed(whole.replace(b"Normal.X", b"Abnorm.X")))
    with pytest.raises(CheckpointError, match="cannot be read"):
        read_checkpoint(path)


def test_a_place_that_cannot_be_written_to(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(PictureError, match="cannot be written"):
        checkpoints.write_part(tmp_path / "file" / "still.exr", 0, 5)


_WRITE_FOR_EVER = """
import sys
sys.path[:0] = sys.argv[2:]
from support import checkpoints
iteration = 0
while True:
    iteration += 1
    checkpoints.write_part(sys.argv[1], 0, iteration)
    print(iteration, flush=True)
"""


def test_a_writer_that_is_killed_leaves_a_whole_file(tmp_path):
    """kill -9 at any moment: there is the file of before or the new one, and never half of one."""
    path = tmp_path / "still.exr"
    generator = random.Random(3)
    folders = [str(Path(__file__).parents[3]), str(Path(__file__).parents[4])]
    for _ in range(4):
        command = [sys.executable, "-c", _WRITE_FOR_EVER, str(path), *folders]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
            process.stdout.readline()
            time.sleep(0.05 * generator.random())
            process.send_signal(signal.SIGKILL)
            told = process.stdout.read().split()
        summary, pause = read_checkpoint(path)
        if told:
            assert summary.iteration - int(told[-1]) in (0, 1)
        np.testing.assert_array_equal(pause.state.radiance, checkpoints.pause(0, summary.iteration).state.radiance)


def test_automatic_photons_are_another_still_than_their_first_number():
    """Later iterations may have fewer."""
    scene = full_scene()
    scene.settings.photons = 0
    automatic = still_render(scene, {})
    scene.settings.photons = scene.photon_count
    assert automatic != still_render(scene, {})
