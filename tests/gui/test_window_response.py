# SPDX-License-Identifier: GPL-3.0-or-later
"""How soon the rendered viewport of a real Blender window shows edits, and what it costs the user: `make test-gui` runs
this module with no other beside it."""

import time

import numpy as np
from viewport_window import (
    WIDE,
    assert_alike,
    distinct_pictures,
    final_render,
    from_camera,
    latency,
    report,
    show_rendered,
    summary,
    wait_for_rest,
)

RENDERING_SECONDS = 6.0
"""For which the window is watched while a viewport renders: for its timer, some thousand times."""


def test_edits_show_soon_and_end_in_the_final_render(viewport):
    show_rendered(viewport)
    wait_for_rest(viewport)
    edits = {
        "move": ("move_object", {"name": "Gold Band", "offset": [0.5, -0.3, 0.3]}),
        "paint": ("paint", {"material": "Floor", "color": [0.05, 0.2, 0.8, 1.0]}),
        "dim": ("assign", {"path": "bpy.data.lights['Lamp'].energy", "value": 20.0}),
        "hide": ("assign", {"path": "bpy.data.objects['Crystal'].hide_viewport", "value": True}),
        "camera": ("move_object", {"name": "Camera", "offset": [0.3, 0.0, 0.2]}),
    }
    before = viewport.screenshot("before", "VIEW_3D").astype(float)
    measured = {}
    for name, (step, arguments) in edits.items():
        measured[name] = latency(viewport, step, **arguments)
        wait_for_rest(viewport)
        after = viewport.screenshot(name, "VIEW_3D").astype(float)
        assert np.abs(after - before).mean() > 0.5, f"nothing to be seen of {name}"
        before = after
    report(viewport, latency_seconds=measured)
    viewport.step("assign", path="bpy.data.objects['Crystal'].hide_render", value=True)
    report(viewport, **assert_alike(before, final_render(viewport, "final")))
    assert max(measured.values()) < 5.0, measured  # 1.5 s on an idle machine
    viewport.quit()


def test_the_window_answers_while_it_renders(open_blender):
    viewport = from_camera(open_blender("small.blend"), WIDE)
    viewport.step("tick")
    time.sleep(2.0)
    idle = summary(viewport.step("gaps"))
    viewport.step("assign", path="scene.rppm.preview_samples", value=100000)
    viewport.step("free_view")
    plain, _, _ = orbit(viewport)
    show_rendered(viewport)
    time.sleep(1.0)
    viewport.step("time_engine")
    viewport.step("tick")
    viewport.step("watch")
    time.sleep(RENDERING_SECONDS)
    seen, rendering = viewport.step("seen"), summary(viewport.step("gaps"))
    refinements = distinct_pictures(seen) / RENDERING_SECONDS
    orbiting, seen, seconds = orbit(viewport)
    viewport.screenshot("orbited", "VIEW_3D")
    calls = {name: summary(times) for name, times in viewport.step("engine_times").items()}
    report(
        viewport,
        timer_gaps_idle=idle,
        timer_gaps_orbiting_in_solid_mode=plain,
        timer_gaps_rendering=rendering,
        timer_gaps_orbiting=orbiting,
        pictures_a_second_at_rest=refinements,
        pictures_a_second_orbiting=distinct_pictures(seen) / seconds,
        engine_milliseconds=calls,
    )
    assert distinct_pictures(seen) >= 3
    assert min(seen["means"]) > 0.2 * np.median(seen["means"]), "a black flash"
    # The aim is 50 ms at most on an idle machine; one that others use has gaps of its own. While the view turns, what
    # takes longest is a redraw of the window, which a slow machine draws as slowly in Solid mode.
    assert rendering["p95"] < 50.0 + idle["p95"]
    assert orbiting["p95"] < 50.0 + plain["p95"]
    assert calls["view_draw"]["p95"] < 20.0
    viewport.quit()


def orbit(blender):
    """Drag with the middle mouse button over the viewport; returns gaps between timers, what was seen, and seconds."""
    x, y, width, height = blender.step("rectangle", kind="VIEW_3D")
    blender.step("tick")
    blender.step("watch")
    started = time.monotonic()
    drag = ["mousemove", x + width // 2, y + height // 2, "mousedown", 2]
    for _ in range(40):
        drag += ["mousemove_relative", "--", 3, 1, "sleep", 0.1]
    blender.machine.press(*drag, "mouseup", 2)
    seconds = time.monotonic() - started
    return summary(blender.step("gaps")), blender.step("seen"), seconds
