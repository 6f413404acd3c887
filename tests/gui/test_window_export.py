# SPDX-License-Identifier: GPL-3.0-or-later
"""A window goes on while a large file is exported for a rendered viewport; what is seen first, and when."""

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
ENGINES = ("RPPM", "CYCLES")
ORBITS = 12
"""Views of an orbit."""


def heartbeat(blender, occasion):
    """How long timers waited since tick(), milliseconds, and what of that Blender's own thread had to do."""
    gaps, busy = (summary(blender.step(step, 60.0)) for step in ("gaps", "busy_gaps"))
    return {f"{occasion}, gaps": gaps, f"{occasion}, gaps in processor time": busy}


def test_many_objects_are_exported_in_slices(open_blender):
    blender = open_blender("many.blend")
    blender.shrink("VIEW_3D", 480, 270)
    blender.point_at("VIEW_3D")
    blender.step("count_slices")
    blender.step("tick")
    blender.step("free_view")
    blender.step("shading", kind="RENDERED")
    slices = blender.wait_until("slices", 120.0, lambda found: found and found[-1] is None)
    report(blender, slices=len(slices), **heartbeat(blender, "first"))
    done = [slice_ for slice_ in slices if slice_ is not None and slice_[1]]
    assert slices[-1] is None and done  # few, as redraws are slow here
    assert done == sorted(done) and all(of >= 1600 for _, of in done)
    shown = blender.step("evaluate", text="sum(o.visible_get() for o in scene.objects if o.type == 'MESH')")
    assert shown >= 1600
    # What is there is not exported again.
    before = len(slices)
    blender.step("move_object", name="Tile", offset=[0.0, 0.0, 0.1])
    blender.step("turn", degrees=5.0)
    time.sleep(1.0)
    assert all(slice_ is None for slice_ in blender.step("slices")[before:])
    blender.screenshot("many")
    # Nor after another shading, but for what has changed meanwhile.
    blender.step("count_meshes")
    blender.step("tick")
    for kind in ("SOLID", "RENDERED"):
        blender.step("shading", kind=kind)
        if kind == "SOLID":
            blender.step("edit_mesh", name="Tile.007")
        time.sleep(2.0)
    assert blender.step("exported_meshes") == ["Tile.007"]
    report(blender, **heartbeat(blender, "switched"))
    blender.quit()


@pytest.mark.long
@pytest.mark.parametrize("name", ["bathroom", "bmw27"])
@pytest.mark.parametrize("engine", ENGINES)
def test_the_longest_gap_while_a_scene_is_switched_to_rendered(open_blender, session_folder, name, engine):
    """Measured, for both engines; nothing but that there is a picture is asked for."""
    source = SCENES / f"{name}.blend"
    if not source.is_file():
        pytest.skip(f"{source} is not there")
    shutil.copyfile(source, session_folder / source.name)
    blender = open_blender(source.name)
    blender.step("assign", 60.0, path="scene.render.engine", value=engine)
    blender.shrink("VIEW_3D", 480, 270)
    blender.point_at("VIEW_3D")
    measured = {}
    for occasion in ("first", "again"):
        blender.step("shading", 60.0, kind="SOLID")
        time.sleep(2.0)
        blender.step("time_engine", name=engine)
        blender.step("tick")
        started = blender.step("clock")
        blender.step("shading", 60.0, kind="RENDERED")
        time.sleep(8.0)
        gaps, beats = blender.step("gaps", 60.0), heartbeat(blender, occasion)
        walls, busy = (blender.step(step)["view_update"] for step in ("engine_times", "engine_busy"))
        measured |= beats
        measured[occasion] = {
            "longest": sorted(gaps)[-5:],
            "over_100": sum(gap for gap in gaps if gap > 100.0),
            "updates": len(walls),
            "longest_update": max(walls),
            "updates_in_total": sum(walls),
            "processor_in_total": sum(busy),
        }
        assert blender.step("clock") > started
        blender.screenshot(f"{name}_{engine}_{occasion}")
    report(blender, **measured)
    blender.quit()


@pytest.mark.long
@pytest.mark.parametrize(
    "name", ["startup", "bmw27", "wild/loft", "wild/donut_table"], ids=lambda name: Path(name).name
)
@pytest.mark.parametrize(
    ("engine", "occasion"), [("RPPM", "first"), ("RPPM", "again"), ("CYCLES", "first"), (PLAIN, "first")]
)
def test_the_first_pictures_of_a_file(open_blender, session_folder, name, engine, occasion):
    """Measured: seconds to the first picture and to the first sample, and how long timers wait then and in an orbit.

    Where a file is opened again, RPPM's caches are full. Nothing but that there is a picture is asked for.
    """
    file = f"{Path(name).name}.blend"
    if name != "startup":
        if not (SCENES / f"{name}.blend").is_file():
            pytest.skip(f"{name}.blend is not there")
        shutil.copyfile(SCENES / f"{name}.blend", session_folder / file)
    blender = open_blender(file)
    blender.step("assign", 60.0, path="scene.render.engine", value=engine)
    blender.shrink("VIEW_3D", *WIDE)
    blender.step("plain_viewport", 60.0)
    blender.step("camera_view", 60.0)
    blender.point_at("VIEW_3D")
    measured = switch_to_rendered(blender, engine) if engine != PLAIN else {}
    blender.screenshot(f"{Path(name).name}_{engine}_{occasion}")
    blender.step("tick", 60.0)
    for _ in range(ORBITS):
        blender.step("turn", 60.0, degrees=3.0)
        time.sleep(0.25)
    report(blender, **measured, gaps_of_orbit=summary(blender.step("gaps", 60.0)))
    blender.quit()


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
