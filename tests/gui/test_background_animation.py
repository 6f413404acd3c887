# SPDX-License-Identifier: GPL-3.0-or-later
"""Animations of Blender's own command line, with the installed extension."""

import numpy as np
import pytest
from blender_window import blender_in_background, read_png
from chroot_machine import MachineError

FRAMES = range(1, 7)


def pictures(machine, name, frames):
    """By frame, those of the session's folder."""
    found = {int(path.stem[-4:]): read_png(path) for path in machine.folder.glob(f"{name}_????.png")}
    assert sorted(found) == sorted(frames)
    return found


@pytest.mark.parametrize("persistent", [False, True])
def test_every_frame_equals_a_single_one(machine, persistent):
    """-a with a start, an end and a step; -f with single frames."""
    choose = f"import bpy; bpy.context.scene.render.use_persistent_data = {persistent}"
    file = ["/mnt/moving.blend", "--python-expr", choose, "--render-format", "PNG", "--render-output"]
    output = blender_in_background(machine, *file, "/mnt/all_####", "-s", "1", "-e", "6", "-a")
    assert "Sample 2/2" in output
    every = pictures(machine, "all", FRAMES)
    blender_in_background(machine, *file, "/mnt/some_####", "-s", "2", "-e", "6", "-j", "2", "-a")
    some = pictures(machine, "some", (2, 4, 6))
    blender_in_background(machine, *file, "/mnt/single_####", "-f", "3,6")
    single = pictures(machine, "single", (3, 6))
    for chosen in (some, single):
        for frame, picture in chosen.items():
            np.testing.assert_array_equal(picture, every[frame])
    assert len({picture.tobytes() for picture in every.values()}) == len(FRAMES)


def test_a_broken_frame_leaves_no_file_and_the_others_go_on(machine):
    file = ["/mnt/broken.blend", "--render-format", "PNG", "--render-output", "/mnt/broken_####"]
    with pytest.raises(MachineError, match=r"(?s)failed with 1:.*Frame 3 has no picture: radius_maximum"):
        blender_in_background(machine, *file, "-s", "1", "-e", "4", "-a")
    pictures(machine, "broken", (1, 2, 4))


@pytest.mark.parametrize("signal", ["INT", "KILL"])
def test_whoever_ends_it_leaves_whole_files(machine, signal):
    """Blender writes the files; the frame that is rendered is not among them."""
    start = "blender --background /mnt/moving.blend --render-format PNG --render-output /mnt/ended_#### -s 1 -e 4000 -a"
    wait = "while [ ! -e /mnt/ended_0003.png ]; do sleep 0.02; done"
    command = f"{start} & pid=$!; {wait}; kill -{signal} $pid; wait $pid; echo ended with $?"
    output = machine.run(["sh", "-c", command], {"BLENDER_USER_RESOURCES": "/mnt/user"}, 240.0)
    assert "ended with" in output and "Traceback" not in output
    assert not machine.processes()
    found = sorted(machine.folder.glob("ended_????.png"))
    assert 3 <= len(found) < 4000
    sizes = {read_png(path).shape for path in found[:-1] if signal == "KILL"} or {read_png(p).shape for p in found}
    assert len(sizes) == 1


def test_what_cannot_be_opened_ends_with_a_status(machine):
    with pytest.raises(MachineError, match="failed with"):
        blender_in_background(machine, "/mnt/nothing.blend", "-a")
