# SPDX-License-Identifier: GPL-3.0-or-later
"""Several viewports at once, and what one of them shows alone."""

import numpy as np
from viewport_window import WIDE, arrange, assert_alike, blocks, report, show_rendered, wait_for_rest

ALONE = ["Gold Band", "Lamp", "Floor"]


def shown(blender, name):
    """Return the pictures of the two viewports, both of one size."""
    screen = blender.screenshot(name)
    rectangles = blender.step("viewport_rectangles")
    width = min(width for _, _, width, _ in rectangles)
    return [screen[y : y + height, x : x + width] for x, y, _, height in rectangles]


def likeness(one, other):
    return np.corrcoef(blocks(one).ravel(), blocks(other).ravel())[0, 1]


def test_viewports_render_at_once_and_alone(open_blender):
    blender = open_blender("small.blend")
    arrange(blender, WIDE)
    blender.step("free_view")
    show_rendered(blender)
    blender.step("halve_viewport")
    blender.wait_until("ready", 10.0)
    blender.step("turn_viewport", index=1, degrees=25.0)
    wait_for_rest(blender)
    left, right = shown(blender, "turned")
    assert likeness(left, right) < 0.9

    blender.step("copy_view", source=1, target=0)
    wait_for_rest(blender)
    again, untouched = shown(blender, "same")
    report(blender, same_view=assert_alike(again, right))
    assert_alike(untouched, right)

    blender.step("local_view", index=0, names=ALONE)
    wait_for_rest(blender)
    alone, untouched = shown(blender, "local")
    assert likeness(alone, right) < 0.99
    assert_alike(untouched, right)
    blender.step("local_view", index=0, names=ALONE)
    blender.step("show_only", names=ALONE)
    wait_for_rest(blender)
    report(blender, local_view=assert_alike(alone, shown(blender, "hidden")[0]))
    blender.quit()
