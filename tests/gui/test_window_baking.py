# SPDX-License-Identifier: GPL-3.0-or-later
"""The button Bake in a real Blender window with the installed extension."""

import numpy as np


def test_a_bake_in_the_background_gives_what_one_at_once_does(open_blender):
    blender = open_blender("small.blend")
    blender.step("bake")
    blender.wait_until("bake_counts", 240.0, lambda counts: counts["complete"] == 1)
    assert not blender.step("baking")
    baked = np.array(blender.step("baked_image"))
    blender.step("properties_tab", name="RENDER")
    blender.screenshot("after_bake")
    blender.step("bake", 240.0, at_once=True)
    np.testing.assert_array_equal(blender.step("baked_image"), baked)
    assert baked.std() > 0.0 and np.isfinite(baked).all()
    blender.quit()


def test_esc_stops_a_bake(open_blender):
    blender = open_blender("endless.blend")
    blender.point_at("VIEW_3D")
    blender.step("bake")
    blender.wait_until("baking", 30.0)
    blender.press("Escape")
    blender.wait_until("baking", 60.0, lambda is_baking: not is_baking)
    blender.quit()
