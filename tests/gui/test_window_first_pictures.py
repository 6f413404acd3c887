# SPDX-License-Identifier: GPL-3.0-or-later
"""What an artist waits for who opens a file and switches to Rendered: RPPM beside Cycles, in the same window."""

import os
import shutil
import time
from pathlib import Path

import pytest
from viewport_window import WIDE, report, show_rendered, summary

SCENES = Path(os.environ.get("SCENES", Path(__file__).resolve().parents[3] / "shared" / "scenes"))
"""Scenes of other makers, which are no part of the repository."""
PLAIN = "BLENDER_WORKBENCH"
"""Engine of a window that stays in Solid, which tells how long a plain redraw takes."""
ENGINES = ("RPPM", "CYCLES", PLAIN)
ORBITS = 12
"""Views of an orbit."""


@pytest.mark.long
@pytest.mark.parametrize("name", ["startup", "bmw27", "wild/loft", "wild/donut_table"])
@pytest.mark.parametrize("engine", ENGINES)
def test_the_first_pictures_of_a_file(open_blender, session_folder, name, engine):
    """Measured: seconds to the first picture and to the first sample, and how long timers wait then and in an orbit.

    The second time, RPPM's caches are full. Nothing but that there is a picture is asked for.
    """
    file = f"{Path(name).name}.blend"
    if name != "startup":
        if not (SCENES / f"{name}.blend").is_file():
            pytest.skip(f"{name}.blend is not there")
        shutil.copyfile(SCENES / f"{name}.blend", session_folder / file)
    measured = {}
    for occasion in ("first", "again") if engine == "RPPM" else ("first",):
        blender = open_blender(file)
        blender.step("assign", 60.0, path="scene.render.engine", value=engine)
        blender.shrink("VIEW_3D", *WIDE)
        blender.step("plain_viewport", 60.0)
        blender.point_at("VIEW_3D")
        measured[occasion] = switch_to_rendered(blender, engine) if engine != PLAIN else {}
        blender.screenshot(f"{Path(name).name}_{engine}_{occasion}")
        blender.step("tick", 60.0)
        for _ in range(ORBITS):
            blender.step("turn", 60.0, degrees=3.0)
            time.sleep(0.25)
        measured[occasion]["gaps_of_orbit"] = summary(blender.step("gaps", 60.0))
        blender.quit()
    report(blender, **measured)


def switch_to_rendered(blender, engine):
    """Seconds to the pictures of an engine, and milliseconds that timers wait meanwhile and 5 s longer."""
    if engine == "RPPM":
        blender.step("count_samples", 60.0)
    blender.step("tick", 60.0)
    found = {"first_picture_seconds": show_rendered(blender)}
    if engine == "RPPM":
        started = blender.step("changed", 60.0) - found["first_picture_seconds"]
        found["first_sample_seconds"] = blender.wait_until("sampled", 120.0) - started
    time.sleep(5.0)
    found["gaps"] = summary(blender.step("gaps", 60.0))
    return found
