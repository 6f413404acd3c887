# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes lighthouse.blend: a model of a lighthouse in fog, whose lamp is between two lenses."""

import math

import bpy
from stage import ball, block, camera, color_world, diffuse, glass, lathe, light, plate, save, set_up
from volumes import scattering, set_volume_bounces

LAMP, FOCUS, IOR, HALF_ANGLE = 3.0, 0.16, 1.5, math.radians(34)
FRAMES = 48
EDGE = math.radians(30)


def lens_profile(steps=40):
    """A lens from a hyperbola to a plane, which makes the light of its focus, the origin, parallel to Z."""
    front = []
    for k in range(steps + 1):
        angle = HALF_ANGLE * k / steps
        reach = (IOR - 1.0) * FOCUS / (IOR * math.cos(angle) - 1.0)
        front.append((reach * math.sin(angle) if k else 0.0, reach * math.cos(angle)))
    rim, end = front[-1]
    return [*front, (rim, end + 0.02), (0.0, end + 0.02)]


def tower():
    """Bands of white and red, a gallery, and a roof on posts."""
    for number in range(5):
        low, high = 0.25 + 0.48 * number, 0.25 + 0.48 * (number + 1)
        wide, narrow = (0.52 - 0.075 * z for z in (low, high))
        color = ((0.75, 0.72, 0.68), (0.55, 0.05, 0.035))[number % 2]
        profile = [(0.0, low), (wide, low), (narrow, high), (0.0, high)]
        lathe(f"Band {number}", profile, diffuse(f"Band {number}", color), 96).data.set_sharp_from_angle(angle=EDGE)
    dark = diffuse("Iron", (0.03, 0.032, 0.035))
    for name, profile in (
        ("Gallery", [(0.0, 2.65), (0.50, 2.65), (0.50, 2.70), (0.0, 2.70)]),
        ("Roof", [(0.0, 3.32), (0.46, 3.32), (0.06, 3.62), (0.0, 3.78)]),
    ):
        lathe(name, profile, dark, 96).data.set_sharp_from_angle(angle=EDGE)
    for k in range(8):
        turn = math.tau * (k + 0.5) / 8
        x, y = 0.42 * math.cos(turn), 0.42 * math.sin(turn)
        block(f"Post {k}", (x - 0.01, y - 0.01, 2.70), (x + 0.01, y + 0.01, 3.32), dark)


def lantern():
    """The lamp in a drum with a lens at either end."""
    rim, end = lens_profile()[-2]
    axis = bpy.data.objects.new("Axis", None)
    bpy.context.collection.objects.link(axis)
    axis.location = (0.0, 0.0, LAMP)
    wall = [(rim + 0.004, -end), (rim + 0.014, -end), (rim + 0.014, end), (rim + 0.004, end)]
    drum = lathe("Drum", wall, diffuse("Brass", (0.4, 0.27, 0.10)))
    clear = glass("Lens", (1.0, 1.0, 1.0), IOR)
    lenses = [lathe(f"Lens {k}", lens_profile(), clear, 128) for k in range(2)]
    for part, turn in ((drum, 90), (lenses[0], 90), (lenses[1], -90)):
        part.parent, part.rotation_euler.y = axis, math.radians(turn)
    for lens in lenses:
        lens.data.set_sharp_from_angle(angle=EDGE)
    # Half a turn, after which the lantern looks the same again.
    bpy.context.preferences.edit.keyframe_new_interpolation_type = "LINEAR"
    for frame, turn in ((1, -27.0), (FRAMES + 1, 153.0)):
        axis.rotation_euler.z = math.radians(turn)
        axis.keyframe_insert("rotation_euler", frame=frame)
    light("POINT", "Lamp", (0, 0, LAMP), (0, 0, 0), 900.0, (1.0, 0.86, 0.62), shadow_soft_size=0.004)


def build(scene):
    plate("Sea", 0.0, 0.0, 60.0, 60.0, 0.0, diffuse("Sea", (0.05, 0.09, 0.13)))
    stone = diffuse("Rock", (0.10, 0.095, 0.09))
    rocks = ((0.0, 0.0, 1.05, 0.30), (-0.9, 0.15, 0.55, 0.22), (0.85, -0.25, 0.6, 0.25), (0.25, -0.7, 0.5, 0.2))
    for number, (x, y, radius, height) in enumerate((*rocks, (-1.9, -0.5, 0.25, 0.12), (1.75, 0.4, 0.22, 0.12))):
        ball(f"Rock {number}", (x, y, 0.0), radius, stone, 24).scale.z = height / radius
    tower()
    lantern()
    block("Fog", (-9.0, -8.5, -0.1), (9.0, 8.0, 7.0), scattering("Fog", (0.9, 0.95, 1.0), 0.055, 0.35))
    color_world(scene, (0.10, 0.19, 0.36), 0.3)
    camera((0.6, -7.0, 0.8), (0.15, 0.0, 2.05), 31.0)
    set_up(scene, 640, 360, exposure=0.8)
    scene.render.fps, scene.frame_start, scene.frame_end = 24, 1, FRAMES
    set_volume_bounces(scene, rppm=0, cycles=1)


if __name__ == "__main__":
    save(build)
