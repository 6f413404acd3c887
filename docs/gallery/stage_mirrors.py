# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes stage_mirrors.blend: spotlights meet mirrors, and their beams a figure in the middle of the stage."""

import math

from stage import (
    Vector,
    add_faces,
    ball,
    camera,
    color_world,
    diffuse,
    lathe,
    light,
    metal,
    plate,
    save,
    set_up,
    smooth_line,
    varnished,
)


def mirror(name, place, source, target, width, height, surface):
    """A mirror that sends light from a source to a target."""
    place = Vector(place)
    half = ((Vector(source) - place).normalized() + (Vector(target) - place).normalized()).normalized()
    a, b = width / 2, height / 2
    made = add_faces(name, [(-a, -b, 0), (a, -b, 0), (a, b, 0), (-a, b, 0)], [(0, 1, 2, 3)], surface)
    made.location, made.rotation_euler = place, half.to_track_quat("Z", "Y").to_euler()
    return made


FIGURE = (
    (0.0, 0.0),
    (0.30, 0.0),
    (0.26, 0.10),
    (0.10, 0.25),
    (0.16, 0.75),
    (0.27, 1.15),
    (0.20, 1.45),
    (0.07, 1.62),
    (0.0, 1.64),
)


def build(scene):
    plate("Stage", 0.0, 0.0, 9.0, 7.0, 0.0, varnished("Boards", (0.30, 0.19, 0.11), 0.3))
    add_faces(
        "Curtain",
        [(-4.5, 2.6, 0), (4.5, 2.6, 0), (4.5, 2.6, 4), (-4.5, 2.6, 4)],
        [(3, 2, 1, 0)],
        diffuse("Curtain", (0.34, 0.03, 0.04)),
    )
    lathe("Figure", smooth_line(FIGURE), diffuse("Plaster", (0.78, 0.76, 0.72)))
    ball("Head", (0.0, 0.0, 1.80), 0.17, diffuse("Plaster Head", (0.78, 0.76, 0.72)))
    silver = metal("Mirror", (0.93, 0.93, 0.94), 0.0)
    colors = ((1.0, 0.25, 0.16), (0.2, 0.9, 0.35), (0.22, 0.38, 1.0))
    for number, color in enumerate(colors):
        angle = math.radians(205 + 65 * number)
        place = Vector((2.1 * math.cos(angle), 1.5 * math.sin(angle) + 0.35, 0.55))
        source = Vector((2.7 * math.cos(angle + 0.5), 2.0 * math.sin(angle + 0.5) + 1.6, 3.6))
        mirror(f"Mirror {number}", place, source, (0.0, 0.0, 1.1), 0.52, 0.78, silver)
        light(
            "SPOT",
            f"Spot {number}",
            source,
            place,
            5000.0,
            color,
            shadow_soft_size=0.03,
            spot_size=math.radians(13),
            spot_blend=0.25,
        )
    color_world(scene, (0.5, 0.5, 0.7), 0.03)
    camera((0.0, -5.9, 2.5), (0.0, 0.0, 0.85), 30.0)
    set_up(scene)


if __name__ == "__main__":
    save(build)
