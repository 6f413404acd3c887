# SPDX-License-Identifier: GPL-3.0-or-later
"""Inside a background Blender: saves what the tests open, small versions of the sample scene, in /mnt."""

import bpy

SIZE = (96, 64)
"""Pixels of final renders."""


def save(name: str) -> None:
    bpy.ops.wm.save_as_mainfile(filepath=f"/mnt/{name}.blend", copy=True)


bpy.ops.wm.open_mainfile(filepath="/mnt/first_light.blend")
scene = bpy.context.scene
assert scene.render.engine == "RPPM", scene.render.engine
render = scene.render
render.resolution_x, render.resolution_y, render.resolution_percentage = *SIZE, 100
render.image_settings.file_format, render.dither_intensity = "PNG", 0.0
scene.rppm.iterations, scene.rppm.photons, scene.rppm.time_limit = 4, 4096, 0.0
save("small")
scene.rppm.iterations = 1000000
save("endless")
