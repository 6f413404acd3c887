# SPDX-License-Identifier: GPL-3.0-or-later
"""The rendered viewport in a real Blender window: what it shows, and what it outlives."""

import time

import numpy as np
import pytest
from blender_window import StepError, nothing_left
from viewport_window import (
    ITERATIONS,
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


def test_a_viewport_at_rest_shows_the_final_render(viewport):
    first = show_rendered(viewport)
    wait_for_rest(viewport)
    shown = viewport.screenshot("viewport", "VIEW_3D")
    viewport.screenshot("window")
    report(viewport, first_picture_seconds=first, **assert_alike(shown, final_render(viewport, "final")))
    viewport.quit()


def test_an_animation_plays(viewport):
    viewport.step("animate", name="Gold Band", offset=[0.6, -0.4, 0.0], frames=20)
    viewport.step("assign", path="scene.frame_end", value=21)
    without = play(viewport, 1.0)[1]
    show_rendered(viewport)
    wait_for_rest(viewport)
    seen, gaps = play(viewport, 2.0, pictures=3)
    report(
        viewport,
        pictures_a_second_playing=distinct_pictures(seen) / (seen["now"] - seen["times"][0]),
        timer_gaps_playing=gaps,
        timer_gaps_playing_solid=without,
    )
    viewport.step("set_frame", frame=21)
    wait_for_rest(viewport)
    shown = viewport.screenshot("viewport", "VIEW_3D")
    report(viewport, **assert_alike(shown, final_render(viewport, "final")))
    viewport.quit()


def play(blender, seconds, pictures=0):
    """Play the animation for some seconds, and until that many pictures have followed one another: what was seen, and
    the gaps between timers."""
    blender.step("watch")
    blender.step("tick")
    blender.step("play")
    assert blender.step("playing")
    time.sleep(seconds)
    seen = blender.wait_until("seen", 60.0, lambda seen: distinct_pictures(seen) >= pictures)
    gaps = summary(blender.step("gaps"))
    blender.step("play")
    assert not blender.step("playing")
    return seen, gaps


def test_the_viewport_outlives_renders_engines_and_files(viewport):
    show_rendered(viewport)
    viewport.step("assign", path="scene.rppm.samples", value=1000000)
    viewport.press("F12")
    viewport.wait_until("rendering", 60.0)
    time.sleep(1.0)
    viewport.screenshot("rendering")
    started = viewport.step("clock")
    viewport.press("Escape")
    viewport.wait_until("render_counts", 30.0, lambda counts: counts["cancelled"] == 1)
    report(viewport, seconds_to_cancel=viewport.step("clock") - started)
    wait_for_rest(viewport)
    viewport.screenshot("after_cancel")
    for engine in ("BLENDER_EEVEE", "CYCLES", "BLENDER_WORKBENCH"):
        viewport.step("assign", 60.0, path="scene.render.engine", value=engine)
        viewport.step("draw_window", 60.0)
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
    viewport.step("clock", 10.0)
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
