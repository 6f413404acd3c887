# SPDX-License-Identifier: GPL-3.0-or-later
"""The recipe of docs/farm.md for farm managers, with the installed extension: what they run, and what they are told."""

import re
from pathlib import Path

import pytest
from blender_window import USER_FOLDER, MachineError, blender_in_background

RECIPE = (Path(__file__).resolve().parents[2] / "docs" / "farm.md").read_text()
CHECK = re.search(r"^CHECK='(.*)'$", RECIPE, re.MULTILINE)[1]
CHUNK = ("/mnt/small.blend", "--python-exit-code", "3", "-E", "RPPM", "-o", "/mnt/farm_####", "-F", "PNG", "-x", "1")
CHUNK += ("-s", "1", "-e", "3", "-j", "2", "-a", "--python-expr", CHECK)


def test_a_chunk_of_frames(machine):
    output = blender_in_background(machine, *CHUNK)
    frame, sample, remaining, memory, saved = re.search(r"Regular expressions: `(.*)`", RECIPE)[1].split("`, `")
    assert set(re.findall(frame, output)) == {"1", "3"}
    left = [tuple(map(int, digits)) for digits in re.findall(remaining, output)]
    assert left[-1] == (0, 0, 0) and len(left) == 8
    assert all(0.0 < float(used) <= float(peak) for used, peak in re.findall(memory, output)[-2:])
    assert "| Scene, ViewLayer | Sample 4/4" in output
    told = [tuple(map(int, counts)) for counts in re.findall(sample, output)]
    assert max(told) == (told[0][1], told[0][1])
    assert re.findall(saved, output) == ["/mnt/farm_0001.png", "/mnt/farm_0003.png"]
    assert sorted(path.name for path in machine.folder.glob("farm_*")) == ["farm_0001.png", "farm_0003.png"]


def test_frames_without_a_picture_fail_the_job(machine):
    with pytest.raises(MachineError, match=r"(?s)failed with 3:.*has no picture.*\[1, 3\]"):
        machine.run(["blender", "--background", *CHUNK], USER_FOLDER | {"RPPM_DEVICE": "7"}, 120.0)
    assert not list(machine.folder.glob("farm_*"))


@pytest.mark.parametrize("frames", ["-s 2 -e 4 -a", "-f 2,3..4"])
def test_frames_without_a_picture_end_with_a_status_of_their_own(machine, frames):
    """The others are rendered, and what was printed is not lost."""
    command = f"blender --background --offline-mode /mnt/broken.blend -o /mnt/farm_#### -F PNG {frames}"
    output = machine.run(["sh", "-c", f"{command}; echo ended with $?"], USER_FOLDER, 120.0)
    assert "ended with 1" in output and "Saved: '/mnt/farm_0004.png'" in output and "Frame 3 has no picture" in output
    assert sorted(path.name for path in machine.folder.glob("farm_*")) == ["farm_0002.png", "farm_0004.png"]
    for path in machine.folder.glob("farm_*"):
        path.unlink()


def test_options_behind_two_dashes(machine):
    still = "blender --background --offline-mode /mnt/small.blend -E RPPM -o /mnt/farm_#### -F PNG -f 1"
    for device, status in (("7", 1), ("0", 0)):
        output = machine.run(["sh", "-c", f"{still} -- --rppm-device {device}; echo ended with $?"], USER_FOLDER, 120.0)
        assert f"ended with {status}" in output
    assert [path.name for path in machine.folder.glob("farm_*")] == ["farm_0001.png"]
    (machine.folder / "farm_0001.png").unlink()


def test_a_missing_extension_fails_the_job(machine):
    with pytest.raises(MachineError, match=r"(?s)failed with 1:.*engine not found 'RPPM'"):
        machine.run(["blender", "--background", *CHUNK], {"BLENDER_USER_RESOURCES": "/mnt/nothing"}, 120.0)
    assert not list(machine.folder.glob("farm_*"))
