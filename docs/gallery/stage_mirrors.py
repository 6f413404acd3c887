# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes stage_mirrors.blend: three flat beams go from mirror to mirror over a stage, and through a drum of glass."""

import math

from stage import (
    Vector,
    add_faces,
    block,
    camera,
    color_world,
    diffuse,
    glass,
    lathe,
    light,
    metal,
    plate,
    save,
    set_up,
    slit,
    varnished,
)

DRUM, DRUM_RADIUS = (0.45, 0.15), 0.34
BEAMS = (
    ("Red", (1.0, 0.05, 0.02), ((-2.55, -0.95), (-1.45, 1.45), (-0.45, -1.15), DRUM)),
    ("Green", (0.05, 1.0, 0.08), ((-2.65, 0.15), (2.05, 1.30), (2.05, -1.00), DRUM)),
    ("Blue", (0.03, 0.12, 1.0), ((-2.60, 0.85), (0.95, -1.40), (0.75, 1.60), DRUM)),
)
BEAM_HEIGHT, REACH = 0.12, 10.0


def mirror(name, place, before, after, silver, back):
    """An upright mirror that sends a beam from one place on to another."""
    place = Vector((*place, 0.0))
    facing = ((Vector((*before, 0)) - place).normalized() + (Vector((*after, 0)) - place).normalized()).normalized()
    turn = math.atan2(facing.y, facing.x)
    made = add_faces(
        name, [(0, -0.24, 0.01), (0, 0.24, 0.01), (0, 0.24, 0.46), (0, -0.24, 0.46)], [(0, 1, 2, 3)], silver
    )
    frame = block(f"{name} Frame", (-0.03, -0.26, 0.0), (-0.002, 0.26, 0.48), back, 0.004)
    for part in (made, frame):
        part.location, part.rotation_euler.z = place, turn


def curtain(surface, folds=26, columns=624):
    """Behind it all, in folds."""
    points = []
    for i in range(columns + 1):
        x = 4.5 * (2 * i / columns - 1)
        y = 2.6 + 0.11 * math.sin(math.tau * folds * i / columns + 0.8 * math.sin(0.05 * i))
        points += [(x, y, 0.0), (x, y, 4.0)]
    faces = [(2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1) for i in range(columns)]
    add_faces("Curtain", points, faces, surface).data.shade_smooth()


def build(scene):
    plate("Stage", 0.0, 0.0, 9.0, 9.0, 0.0, varnished("Boards", (0.30, 0.29, 0.29), 0.5))
    curtain(diffuse("Velvet", (0.26, 0.012, 0.022)))
    silver, black = metal("Mirror", (0.95, 0.95, 0.96), 0.0), varnished("Black", (0.02, 0.02, 0.022), 0.3)
    for name, color, path in BEAMS:
        for number in range(1, len(path) - 1):
            mirror(f"{name} Mirror {number}", path[number], path[number - 1], path[number + 1], silver, black)
        start, along = Vector(path[0]), (Vector(path[1]) - Vector(path[0])).normalized()
        slit(f"{name} Lamp", start, along, 75.0, color, 0.05, BEAM_HEIGHT, REACH, 0.8)
        housing = block(f"{name} Housing", (-0.45, -0.10, 0.0), (-0.01, 0.10, 0.30), black, 0.015)
        housing.location, housing.rotation_euler.z = (*start, 0.0), math.atan2(along.y, along.x)
    drum = lathe("Drum", [(0.0, 0.001), (DRUM_RADIUS, 0.001), (DRUM_RADIUS, 0.40), (0.0, 0.40)], glass("Drum"), 256)
    drum.data.set_sharp_from_angle(angle=math.radians(40))
    drum.location = (*DRUM, 0.0)
    above = light(
        "SPOT",
        "Above",
        (0.0, 0.2, 5.5),
        (0.0, 1.0, 0.3),
        800.0,
        (1.0, 0.86, 0.72),
        shadow_soft_size=0.3,
        spot_size=math.radians(75),
        spot_blend=1.0,
    )
    above.data.rppm.photon_weight = 0.7
    color_world(scene, (0.4, 0.45, 0.9), 0.05)
    camera((-0.15, -4.7, 3.1), (0.0, 0.12, 0.16), 33.0)
    set_up(scene, bounces=12, look="AgX - Punchy")


if __name__ == "__main__":
    save(build)
