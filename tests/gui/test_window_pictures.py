# SPDX-License-Identifier: GPL-3.0-or-later
"""The window as the documents show it; tools/window_pictures.py takes the pictures from out/gui/ to docs/images/."""

import time

import pytest
from viewport_window import wait_for_rest

SECONDS = 400.0
"""Time that the sample may take on a busy machine, seconds."""
SAMPLES = 12


@pytest.mark.long
def test_what_the_documents_show(open_blender):
    blender = open_blender("first_light.blend", 1280, 800)
    blender.step("assign", path="scene.render.engine", value="BLENDER_WORKBENCH")
    blender.step("properties_tab", name="RENDER")
    blender.step("draw_window")
    x, y, width, _ = blender.step("rectangle", kind="PROPERTIES")
    blender.machine.press("mousemove", int(x + 0.7 * width), y + 54, "click", 1)
    time.sleep(2.0)
    menu = blender.screenshot("engine")
    blender.press("Escape")
    blender.step("assign", path="scene.render.engine", value="RPPM")
    blender.step("assign", path="scene.render.preview_pixel_size", value="2")
    for name, value in {"preview_samples": SAMPLES, "photons": 16384, "preview_photons": 16384}.items():
        blender.step("assign", path=f"scene.rppm.{name}", value=value)
    blender.step("camera_view")
    blender.step("shading", kind="RENDERED")
    blender.wait_until("readings", SECONDS, lambda found: found and found["iterations"] >= SAMPLES)
    wait_for_rest(blender)
    blender.step("draw_window")
    rendered = blender.screenshot("viewport")
    blender.step("scroll_to", page=1)
    blender.step("draw_window")
    blender.screenshot("status", "PROPERTIES")
    blender.step("replace_area", kind="VIEW_3D", by="PROPERTIES")
    blender.step("show_preferences")
    blender.step("draw_window")
    time.sleep(1.0)
    blender.screenshot("preferences", "PREFERENCES")
    assert menu.std() > 5.0 and rendered.std() > 5.0
    blender.quit()
