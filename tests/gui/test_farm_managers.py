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
    frame, sample, saved = re.search(r"Regular expressions: `(.*)`, `(.*)`, `(.*)`", RECIPE).groups()
    assert set(re.findall(frame, output)) == {"1", "3"}
    told = [tuple(map(int, counts)) for counts in re.findall(sample, output)]
    assert max(told) == (told[0][1], told[0][1])
    assert re.findall(saved, output) == ["/mnt/farm_0001.png", "/mnt/farm_0003.png"]
    assert sorted(path.name for path in machine.folder.glob("farm_*")) == ["farm_0001.png", "farm_0003.png"]


def test_frames_without_a_picture_fail_the_job(machine):
    with pytest.raises(MachineError, match=r"(?s)failed with 3:.*has no picture.*\[1, 3\]"):
        machine.run(["blender", "--background", *CHUNK], USER_FOLDER | {"RPPM_DEVICE": "7"}, 120.0)
    assert not list(machine.folder.glob("farm_*"))


def test_a_missing_extension_fails_the_job(machine):
    with pytest.raises(MachineError, match=r"(?s)failed with 1:.*engine not found 'RPPM'"):
        machine.run(["blender", "--background", *CHUNK], {"BLENDER_USER_RESOURCES": "/mnt/nothing"}, 120.0)
    assert not list(machine.folder.glob("farm_*"))
