# SPDX-License-Identifier: GPL-3.0-or-later
"""The rendered viewport in a real Blender window: what it shows, how soon, and what it costs the user."""

import time

import numpy as np
import pytest
from blender_window import StepError, nothing_left
from viewport_window import (
    arrange,
    assert_alike,
    distinct_pictures,
    final_render,
    latency,
    renderer_pid,
    report,
    show_rendered,
    summary,
    wait_for_rest,
)

ITERATIONS, PHOTONS = 4, 16384


@pytest.fixture
def viewport(open_blender):
    """A window whose viewport is about to be rendered, from the camera."""
    blender = open_blender("small.blend")
    arrange(blender)
    for name in ("samples", "preview_samples"):
        blender.step("assign", path=f"scene.rppm.{name}", value=ITERATIONS)
    for name in ("photons", "preview_photons"):
        blender.step("assign", path=f"scene.rppm.{name}", value=PHOTONS)
    blender.step("camera_view")
    return blender


def test_a_viewport_at_rest_shows_the_final_render(viewport):
    first = show_rendered(viewport)
    wait_for_rest(viewport)
    shown = viewport.screenshot("viewport", "VIEW_3D")
    viewport.screenshot("window")
    report(viewport, first_picture_seconds=first, **assert_alike(shown, final_render(viewport, "final")))
    viewport.quit()


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


def test_the_window_answers_while_it_renders(viewport):
    viewport.step("tick")
    time.sleep(3.0)
    idle = summary(viewport.step("gaps"))
    viewport.step("assign", path="scene.rppm.preview_samples", value=100000)
    viewport.step("free_view")
    show_rendered(viewport)
    time.sleep(2.0)
    viewport.step("time_engine")
    viewport.step("tick")
    viewport.step("watch")
    time.sleep(8.0)
    seen, rendering = viewport.step("seen"), summary(viewport.step("gaps"))
    refinements = distinct_pictures(seen) / 8.0
    orbiting, seen, seconds = orbit(viewport)
    viewport.screenshot("orbited", "VIEW_3D")
    calls = {name: summary(times) for name, times in viewport.step("engine_times").items()}
    report(
        viewport,
        timer_gaps_idle=idle,
        timer_gaps_rendering=rendering,
        timer_gaps_orbiting=orbiting,
        pictures_a_second_at_rest=refinements,
        pictures_a_second_orbiting=distinct_pictures(seen) / seconds,
        engine_milliseconds=calls,
    )
    assert distinct_pictures(seen) >= 3
    assert min(seen["means"]) > 0.2 * np.median(seen["means"]), "a black flash"
    # The aim is 50 ms at most on an idle machine; one that others use has gaps of its own.
    assert rendering["p95"] < 50.0 + idle["p95"] and orbiting["p95"] < 150.0 + idle["p95"]
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


def test_an_animation_plays(viewport):
    viewport.step("animate", name="Gold Band", offset=[0.6, -0.4, 0.0], frames=20)
    viewport.step("assign", path="scene.frame_end", value=21)
    without = play(viewport, 4.0)[1]
    show_rendered(viewport)
    wait_for_rest(viewport)
    seen, gaps = play(viewport, 8.0)
    report(
        viewport,
        pictures_a_second_playing=distinct_pictures(seen) / 8.0,
        timer_gaps_playing=gaps,
        timer_gaps_playing_solid=without,
    )
    assert distinct_pictures(seen) >= 3
    viewport.step("set_frame", frame=21)
    wait_for_rest(viewport)
    shown = viewport.screenshot("viewport", "VIEW_3D")
    report(viewport, **assert_alike(shown, final_render(viewport, "final")))
    viewport.quit()


def play(blender, seconds):
    """Play the animation: what was seen, and the gaps between timers."""
    blender.step("watch")
    blender.step("tick")
    blender.step("play")
    assert blender.step("playing")
    time.sleep(seconds)
    seen, gaps = blender.step("seen"), summary(blender.step("gaps"))
    blender.step("play")
    assert not blender.step("playing")
    return seen, gaps


def test_the_viewport_outlives_renders_engines_and_files(viewport):
    show_rendered(viewport)
    viewport.step("assign", path="scene.rppm.samples", value=1000000)
    viewport.press("F12")
    viewport.wait_until("rendering", 60.0)
    time.sleep(3.0)
    viewport.screenshot("rendering")
    started = viewport.step("clock")
    viewport.press("Escape")
    viewport.wait_until("render_counts", 30.0, lambda counts: counts["cancelled"] == 1)
    report(viewport, seconds_to_cancel=viewport.step("clock") - started)
    wait_for_rest(viewport)
    viewport.screenshot("after_cancel")
    for engine in ("BLENDER_EEVEE", "CYCLES", "BLENDER_WORKBENCH"):
        viewport.step("assign", 60.0, path="scene.render.engine", value=engine)
        time.sleep(1.0)
        viewport.step("assign", 60.0, path="scene.render.engine", value="RPPM")
    wait_for_rest(viewport)
    again = viewport.screenshot("after_engines", "VIEW_3D")
    viewport.step("assign", path="scene.rppm.samples", value=ITERATIONS)
    report(viewport, **assert_alike(again, final_render(viewport, "final")))
    viewport.step("open_file", 60.0, path="/mnt/endless.blend")
    viewport.wait_until("ready", 30.0)
    arrange(viewport)
    viewport.step("camera_view")
    report(viewport, first_picture_of_another_file_seconds=show_rendered(viewport))
    # What is shown first is a first look, in plain materials.
    for _ in range(60):
        other = viewport.screenshot("other_file", "VIEW_3D")
        if np.corrcoef(again.ravel(), other.ravel())[0, 1] > 0.5:
            break
        time.sleep(0.5)
    else:
        pytest.fail("the other file is not rendered")
    viewport.quit()  # while it renders


def test_the_viewport_survives_its_renderer(viewport):
    show_rendered(viewport)
    wait_for_rest(viewport)
    before = viewport.screenshot("before", "VIEW_3D").astype(float)
    killed = renderer_pid(viewport)
    viewport.machine.kill(killed)
    time.sleep(2.0)
    viewport.wait_until("clock", 10.0)
    end = time.monotonic() + 60.0
    while True:
        try:
            if renderer_pid(viewport) != killed:
                break
        except StepError:
            assert time.monotonic() < end, "the renderer was not started anew"
        time.sleep(0.2)
    wait_for_rest(viewport)
    after = viewport.screenshot("after", "VIEW_3D").astype(float)
    assert np.abs(after.mean((0, 1)) / before.mean((0, 1)) - 1.0).max() < 0.03
    latency(viewport, "move_object", name="Gold Band", offset=[0.5, -0.3, 0.3])
    viewport.quit()


def test_nothing_outlives_a_killed_blender(viewport):
    viewport.step("assign", path="scene.rppm.preview_samples", value=100000)
    show_rendered(viewport)
    viewport.machine.kill(viewport.pid)
    nothing_left(viewport.machine)
