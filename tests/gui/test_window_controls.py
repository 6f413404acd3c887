# SPDX-License-Identifier: GPL-3.0-or-later
"""Controls of a render and a viewport: users pause it and go on, and light the scene otherwise."""

import time

import numpy as np
import pytest
from viewport_window import arrange, show_rendered, wait_for_rest

from rppm_addon.session.checkpoints.checkpoint_file import read_summary


@pytest.mark.long
def test_esc_pauses_and_f12_goes_on(machine, open_blender):
    blender = open_blender("endless.blend")
    blender.step("assign", path="scene.rppm.checkpoint_path", value="/mnt/kept.exr")
    blender.point_at("VIEW_3D")
    for number, seconds in enumerate((3.0, 10.0, 30.0, 90.0), 1):  # until it was stopped within a sample but the first
        blender.press("F12")
        blender.wait_until("render_counts", 60.0, lambda counts, number=number: counts["started"] == number)
        blender.wait_until("rendering", 60.0)
        time.sleep(seconds)
        blender.press("Escape")
        blender.wait_until("render_counts", 120.0, lambda counts, number=number: counts["cancelled"] == number)
        if (machine.folder / "kept.exr").is_file():
            break
    paused = read_summary(machine.folder / "kept.exr").iteration
    assert paused >= 1
    blender.step("assign", path="scene.rppm.samples", value=paused + 2)
    blender.press("F12")
    blender.wait_until("render_counts", 120.0, lambda counts: counts["completed"] == 1)
    assert read_summary(machine.folder / "kept.exr").iteration == paused + 2
    assert "begins anew" not in blender.log()
    blender.quit()


@pytest.mark.long
def test_the_shading_popover_lights_a_viewport(open_blender):
    blender = open_blender("small.blend", 1280, 900)
    arrange(blender)
    blender.step("camera_view")
    for name in ("Ceiling", "Front Wall", "Left Wall", "Back Wall"):
        blender.step("assign", path=f"bpy.data.objects[{name!r}].hide_viewport", value=True)
    show_rendered(blender)

    def seen(name):
        wait_for_rest(blender)
        blender.step("draw_window")
        return blender.screenshot(name, "VIEW_3D").astype(float)

    areas = "bpy.context.window_manager.windows[0].screen.areas"
    shading = f"next(area for area in {areas} if area.type == 'VIEW_3D').spaces.active.shading"
    by_lamps = seen("scene_lights")
    blender.step("assign", path=f"{shading}.use_scene_lights_render", value=False)
    dark = seen("no_lights")
    assert dark.mean() < 0.7 * by_lamps.mean()
    blender.step("assign", path=f"{shading}.use_scene_world_render", value=False)
    lit = seen("studio_light")
    assert lit.mean() > 1.3 * dark.mean()
    blender.step("assign", path=f"{shading}.studiolight_background_alpha", value=1.0)
    open_background = seen("studio_background")
    blender.step("assign", path=f"{shading}.studiolight_background_blur", value=0.8)
    blurred = seen("studio_background_blurred")
    assert np.abs(open_background - lit).mean() > 3.0 and np.abs(blurred - open_background).mean() > 1.0
    assert "Traceback" not in blender.log()
    blender.quit()


def test_choosing_the_engine_prepares_its_programs(open_blender):
    blender = open_blender("small.blend")
    blender.step("assign", path="scene.render.engine", value="BLENDER_WORKBENCH")
    blender.step("end_renderer")
    time.sleep(4.0)  # longer than a file that was opened is idle
    assert blender.step("renderer_state")[0] == "STOPPED"
    blender.step("assign", path="scene.render.engine", value="RPPM")
    blender.wait_until("renderer_state", 60.0, lambda found: found[0] == "RUNNING")
    blender.quit()
