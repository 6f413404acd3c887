# SPDX-License-Identifier: GPL-3.0-or-later
"""Inside a background Blender: saves what the tests open, versions of the sample scene, in /mnt."""

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
scene.rppm.samples, scene.rppm.photons, scene.rppm.time_limit = 4, 4096, 0.0
scene.rppm.preview_samples = scene.rppm.samples
scene.rppm.preview_photons = scene.rppm.photons
save("small")
scene.rppm.samples = scene.rppm.preview_samples = 1000000
save("endless")
scene.rppm.samples, scene.rppm.photons = 2, 1024
scene.rppm.use_animated_seed = False
camera, shown = scene.camera, next(thing for thing in scene.objects if thing.type == "MESH")
for frame in range(1, 8):
    for thing, step in (camera, 0.05), (shown, 0.1):
        thing.location.z += step
        thing.keyframe_insert("location", frame=frame)
save("moving")
for frame, length in (2, 0.0), (3, 1.0), (4, 0.0):
    scene.rppm.radius_minimum, scene.rppm.radius_maximum = 2.0 * length, length
    scene.rppm.keyframe_insert("radius_minimum", frame=frame)
    scene.rppm.keyframe_insert("radius_maximum", frame=frame)
save("broken")

# Many meshes, each of its own, that take a while to export.
bpy.ops.wm.open_mainfile(filepath="/mnt/small.blend")
across, corners = 40, 12
grid = [(x / corners, y / corners, 0.0) for y in range(corners + 1) for x in range(corners + 1)]
row = corners + 1
faces = [(i, i + 1, i + row + 1, i + row) for i in range(row * corners) if i % row < corners]
for number in range(across * across):
    mesh = bpy.data.meshes.new("Tile")
    mesh.from_pydata(grid, [], faces)
    thing = bpy.data.objects.new("Tile", mesh)
    thing.location = (0.1 * (number % across), 0.1 * (number // across), -3.0)
    thing.scale = (0.08, 0.08, 0.08)
    bpy.context.scene.collection.objects.link(thing)
save("many")

# Blender's startup file, as an artist begins.
bpy.ops.wm.read_homefile(use_factory_startup=True)
save("startup")
