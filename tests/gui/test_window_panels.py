# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels and preferences in a real Blender window, drawn without an error; the pictures are to be looked at."""

import time

import numpy as np
from blender_window import StepError
from viewport_window import renderer_pid, wait_for_rest


def shot(blender, name, kind="PROPERTIES"):
    """The area once it has been drawn; something must be there, and Blender must not have complained."""
    blender.step("draw_window")
    picture = blender.screenshot(name, kind)
    assert picture.std() > 5.0
    assert "Traceback" not in blender.log() and "rna_uiItem" not in blender.log(), blender.log()[-4000:]
    return picture


def test_panels_are_drawn(open_blender):
    blender = open_blender("small.blend", 1000, 1500)
    blender.step("assign", path="bpy.context.preferences.view.render_display_type", value="NONE")
    blender.point_at("VIEW_3D")
    blender.press("F12")
    blender.wait_until("render_counts", 120.0, lambda counts: counts["completed"] == 1)
    assert blender.step("open_all_panels") > 20
    blender.step("replace_area", kind="VIEW_3D", by="PROPERTIES")
    blender.step("properties_tab", name="RENDER")
    pages = [(blender.step("scroll_to", page=page), shot(blender, f"render_{page}"))[1] for page in range(2)]
    assert np.abs(pages[0].astype(float) - pages[1]).mean() > 1.0  # the tab is longer than a page
    for tab in ("VIEW_LAYER", "OUTPUT", "WORLD"):
        blender.step("properties_tab", name=tab)
        shot(blender, tab.lower())
    mesh, light, camera = (
        blender.step("evaluate", text=f"next(o.name for o in scene.objects if o.type == {kind!r})")
        for kind in ("MESH", "LIGHT", "CAMERA")
    )
    for name, tabs in ((mesh, ("OBJECT", "MATERIAL")), (light, ("DATA", "OBJECT")), (camera, ("DATA",))):
        blender.step("make_active", name=name)
        blender.step("draw_window")  # the editor learns of the tabs when it is drawn
        for tab in tabs:
            blender.step("properties_tab", name=tab)
            shot(blender, f"{name}_{tab.lower()}")
    # A warning's button shows the object's tab.
    blender.step("press_button", operator="rppm.select_subject", kind="OBJECT", name=mesh)
    assert blender.step("evaluate", text="bpy.context.view_layer.objects.active.name") == mesh
    blender.quit()


def test_preferences_show_the_device(open_blender):
    blender = open_blender("small.blend", 1000, 900)
    blender.step("replace_area", kind="VIEW_3D", by="PROPERTIES")
    blender.step("press_button", operator="rppm.start_renderer")
    state, device, error = blender.wait_until("renderer_state", 90.0, lambda found: found[0] != "STARTING")
    assert state == "RUNNING" and device and not error
    blender.step("show_preferences")
    shot(blender, "preferences", "PREFERENCES")
    blender.quit()


def test_the_viewport_reports_and_pauses(open_blender):
    """The panels learn of its iterations and lights; paused, it does no more of them until it is Rendered anew."""
    blender = open_blender("small.blend", 1280, 900)
    blender.step("assign", path="scene.rppm.preview_samples", value=100000)
    blender.shrink("VIEW_3D", 300, 200)
    blender.step("properties_tab", name="RENDER")
    blender.step("shading", kind="RENDERED")
    found = blender.wait_until("readings", 180.0, lambda found: found and found["iterations"] >= 2)
    assert list(found["watts"]) == ['Light "Lamp"'] and found["watts"]['Light "Lamp"'] > 0.0
    shot(blender, "status")
    blender.step("assign", path="scene.rppm.preview_pause", value=True)
    wait_for_rest(blender)  # what is under way comes to its end
    before = blender.step("readings")["iterations"]
    time.sleep(2.0)
    assert blender.step("readings")["iterations"] == before
    blender.screenshot("paused")
    blender.step("assign", path="scene.rppm.preview_pause", value=False)
    blender.wait_until("readings", 60.0, lambda found: found["iterations"] > before)
    blender.step("shading", kind="SOLID")
    blender.step("assign", path="scene.rppm.preview_pause", value=True)
    blender.step("shading", kind="RENDERED")
    blender.wait_until("evaluate", 60.0, lambda paused: not paused, text="scene.rppm.preview_pause")
    blender.quit()


def test_a_renderer_that_dies_again_and_again(open_blender):
    """Users are told, have a button, and need it not: what asks for pictures tries again by itself."""
    blender = open_blender("small.blend", 1280, 900)
    blender.step("assign", path="scene.rppm.preview_samples", value=100000)
    blender.step("assign", path="bpy.context.preferences.view.render_display_type", value="NONE")
    blender.step("properties_tab", name="RENDER")
    blender.step("shading", kind="RENDERED")
    # Sooner a renderer may not have rendered at all.
    blender.wait_until("readings", 180.0, lambda found: found and found["iterations"] >= 2)
    kill_until_it_stops(blender)
    shot(blender, "stopped_panel")
    blender.screenshot("stopped")
    assert blender.step("press_button", operator="rppm.start_renderer") == ["FINISHED"]
    blender.wait_until("renderer_state", 90.0, lambda found: found[0] == "RUNNING")
    kill_until_it_stops(blender)
    blender.step("shading", kind="SOLID")
    time.sleep(0.5)
    blender.step("shading", kind="RENDERED")
    blender.wait_until("renderer_state", 90.0, lambda found: found[0] == "RUNNING")
    kill_until_it_stops(blender)
    blender.point_at("VIEW_3D")
    blender.press("F12")
    blender.wait_until("render_counts", 180.0, lambda counts: counts["completed"] == 1)
    blender.screenshot("rendered_again")
    blender.quit()


def kill_until_it_stops(blender):
    """Kill the renderer as often as it is started."""
    while True:
        state, *_ = blender.wait_until("renderer_state", 90.0, lambda found: found[0] in {"RUNNING", "FAILED"})
        if state == "FAILED":
            return
        try:
            killed = renderer_pid(blender)
        except StepError:  # dead already: the state follows
            time.sleep(0.2)
            continue
        blender.machine.kill(killed)
        end = time.monotonic() + 30.0
        while killed in blender.machine.processes():
            assert time.monotonic() < end
            time.sleep(0.05)
        time.sleep(0.2)  # the state follows
