# SPDX-License-Identifier: GPL-3.0-or-later
"""Light that grazes a mirror whose normals lean, and that it turns away from the face, against Cycles."""

from mathutils import Vector

from ..comparison import Tolerance
from ..engines import compare_with_cycles
from ..scenes import DIFFUSE, GLOSSY, light, material, new_scene, orthographic_camera, place, plane

GRAZING = Vector((1.5, 0.0, 0.15))
"""Where a lamp stands: light comes at 6 degrees to the face, and counts ten times as much where it is turned upward."""
MEAN = Tolerance(mean=0.01, block=0.1, mode=0.05)


def test_a_mirror_that_leans_toward_grazing_light(renderer):
    scene = new_scene()
    mirror = material(GLOSSY, "GGX", Color=(0.9, 0.9, 0.9), Roughness=0.0)
    card = plane(0.4, mirror)
    card.data.shade_smooth()
    card.data.normals_split_custom_set([(GRAZING.normalized() + Vector((0.0, 0.0, 1.0))).normalized()] * 4)
    plane(1.0, material(DIFFUSE, Color=(0.8, 0.8, 0.8)), place(at=(0.0, 0.0, 1.5), turn=(180.0, 0.0, 0.0)))
    light("AREA", 100.0, place(at=GRAZING, turn=(0.0, 90.0, 0.0)), shape="RECTANGLE", size=0.25, size_y=1.0, spread=0.9)
    scene.render.resolution_x = scene.render.resolution_y = 32
    orthographic_camera(1.6, place(at=(0.0, 0.0, 0.7), turn=(180.0, 0.0, 0.0)))
    compare_with_cycles(renderer, "grazed_mirror", 4096, MEAN, seeds=2, iterations=64, photons=16384)
