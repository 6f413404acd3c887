# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes burning_lens.blend: a magnifying glass focuses the sun on an old letter."""

import math

import bpy
from stage import (
    Matrix,
    Vector,
    camera,
    color_world,
    diffuse,
    glass,
    lathe,
    metal,
    plate,
    save,
    set_up,
    sun,
    torus,
    varnished,
    wood,
)

RADIUS, CURVATURE = 0.045, 0.105
SUN = Vector((0.55, 0.22, -0.80)).normalized()
FOCUS = Vector((0.004, 0.018, 0.0012))
PLACE = FOCUS - 0.088 * SUN
TEXT = """Dear Clara,

the glass came with the morning post, not
one scratch on it. We held it over the desk
at noon, as you wrote we should, and the
sun came through it no larger than a grain
of rice. The paper began to smoke before
Father could say a word. He says it is the
caustic, the burning curve: all the light
that falls on the whole of the lens has to
pass there. I have kept the sheet, with its
hole, to show you when the summer comes
and you are here again.

                        Yours, Emilia"""


def lens_profile(steps=32):
    """A biconvex lens with a small rim."""
    sagitta = CURVATURE - math.sqrt(CURVATURE**2 - RADIUS**2)
    front = []
    for k in range(steps + 1):
        r = RADIUS * k / steps
        front.append((r, math.sqrt(CURVATURE**2 - r * r) - CURVATURE + sagitta + 0.001))
    return [(r, -z) for r, z in front] + [(r, z) for r, z in reversed(front)]


def letter(turn):
    """A sheet with writing."""
    sheet = plate("Letter", 0.0, 0.0, 0.20, 0.26, 0.0010, diffuse("Paper", (0.60, 0.52, 0.38)))
    data = bpy.data.curves.new("Writing", "FONT")
    data.body, data.size, data.space_line, data.shear, data.resolution_u = TEXT, 0.0098, 1.55, 0.25, 3
    data.materials.append(diffuse("Ink", (0.035, 0.022, 0.020)))
    writing = bpy.data.objects.new("Writing", data)
    bpy.context.collection.objects.link(writing)
    sheet.rotation_euler.z = turn
    writing.matrix_world = Matrix.Rotation(turn, 4, "Z") @ Matrix.Translation((-0.084, 0.104, 0.0012))


def build(scene):
    plate("Desk", 0.0, 0.1, 2.0, 1.4, 0.0, wood("Desk", (0.045, 0.018, 0.010), (0.15, 0.065, 0.032), 0.3, -8.0))
    letter(math.radians(9))
    brass = metal("Brass", (0.95, 0.74, 0.38), 0.08)
    lens = lathe("Lens", lens_profile(), glass("Lens", (0.99, 1.0, 0.995), 1.52), 160)
    rim = torus("Rim", RADIUS + 0.0022, 0.0032, brass)
    rod = [(0.0, 0.0), (0.0035, 0.0), (0.0045, 0.02), (0.0075, 0.03), (0.0085, 0.06), (0.007, 0.10), (0.0, 0.104)]
    handle = lathe("Handle", rod, varnished("Handle", (0.05, 0.02, 0.015), 0.1))
    # Square to the sun.
    lens.matrix_world = rim.matrix_world = Matrix.Translation(PLACE) @ SUN.to_track_quat("-Z", "Y").to_matrix().to_4x4()
    held = Vector((0.1, -1.0, 0.0))
    held = (held - held.dot(SUN) * SUN).normalized()
    handle.matrix_world = (
        Matrix.Translation(PLACE + held * (RADIUS + 0.004)) @ held.to_track_quat("Z", "Y").to_matrix().to_4x4()
    )
    sun(SUN, 3.0, (1.0, 0.92, 0.80))
    color_world(scene, (0.50, 0.62, 0.85), 0.14)
    camera((0.05, -0.28, 0.30), (-0.013, 0.010, 0.024), 46.0)
    set_up(scene)


if __name__ == "__main__":
    save(build)
