# SPDX-License-Identifier: GPL-3.0-or-later
"""F12 in a real Blender window with the installed extension."""

import numpy as np
from blender_window import blender_in_background, read_png


def test_f12_renders_what_the_background_renders(machine, open_blender):
    blender_in_background(machine, "/mnt/small.blend", "--render-output", "/mnt/background_#", "--render-frame", "1")
    expected = read_png(machine.folder / "background_1.png").astype(float)
    blender = open_blender("small.blend")
    assert blender.step("evaluate", text="scene.render.engine") == "RPPM"
    blender.step("properties_tab", name="RENDER")
    blender.point_at("VIEW_3D")
    blender.press("F12")
    blender.wait_until("render_counts", 120.0, lambda counts: counts["completed"] == 1)
    blender.screenshot("after_f12")
    blender.step("save_result", path="/mnt/window.png")
    picture = read_png(machine.folder / "window.png").astype(float)
    assert picture.shape == expected.shape and picture.max() > 100
    assert np.abs(picture - expected).mean() < 0.5
    blender.quit()


def test_esc_stops_f12_at_once(open_blender):
    blender = open_blender("endless.blend")
    blender.point_at("VIEW_3D")
    blender.press("F12")
    blender.wait_until("render_counts", 60.0, lambda counts: counts["started"] == 1)
    blender.wait_until("rendering", 30.0)
    blender.screenshot("rendering")
    started = blender.step("clock")
    blender.press("Escape")
    blender.wait_until("render_counts", 30.0, lambda counts: counts["cancelled"] == 1)
    assert blender.step("clock") - started < 10.0
    blender.quit()


def test_engines_and_files_change(open_blender):
    blender = open_blender("small.blend")
    for engine in ("CYCLES", "RPPM", "BLENDER_WORKBENCH", "RPPM"):
        blender.step("assign", path="scene.render.engine", value=engine)
    blender.step("open_file", 60.0, path="/mnt/endless.blend")
    assert blender.step("evaluate", text="scene.render.engine") == "RPPM"
    assert blender.step("evaluate", text="scene.rppm.samples") == 1000000
    blender.quit()


def test_an_animation_renders_what_the_background_renders(machine, open_blender):
    """In one session of the renderer process, which is gone when the last frame is done."""
    file = ["/mnt/moving.blend", "--render-output", "/mnt/background_####", "-s", "1", "-e", "4", "-a"]
    blender_in_background(machine, *file)
    blender = open_blender("moving.blend")
    for path, value in ("filepath", "/mnt/window_####"), ("use_overwrite", True):
        blender.step("assign", path=f"scene.render.{path}", value=value)
    for name, frame in ("frame_start", 1), ("frame_end", 4):
        blender.step("assign", path=f"scene.{name}", value=frame)
    blender.point_at("VIEW_3D")
    blender.press("ctrl+F12")
    blender.wait_until("render_counts", 240.0, lambda counts: counts["completed"] == 1)
    for frame in range(1, 5):
        names = (f"{place}_{frame:04d}.png" for place in ("background", "window"))
        background, window = (read_png(machine.folder / name).astype(float) for name in names)
        assert window.shape == background.shape and window.max() > 100
        np.testing.assert_array_equal(window, background)
    blender.quit()
