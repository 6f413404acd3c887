# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes headlamp.blend: a car's headlamp, whose mirror and ribbed glass throw the bulb's light on a garage wall."""

import math

from stage import (
    add_faces,
    aim,
    block,
    camera,
    color_world,
    diffuse,
    glass,
    lathe,
    light,
    material,
    metal,
    plate,
    save,
    set_up,
)

FOCUS, RADIUS = 0.032, 0.085
HEIGHT = 0.45


def ribbed_pane(surface, columns=192):
    """A disk with ribs that spread light sideways; it faces along +Y."""
    points, faces = [], []
    half, rows = RADIUS + 0.001, 2
    for side in (0, 1):
        for i in range(columns + 1):
            x = half * (2 * i / columns - 1)
            reach = math.sqrt(max(half * half - x * x, 1e-8))
            y = 0.004 + 0.0012 * math.cos(math.tau * 14 * i / columns) if side else 0.0
            points += [(x, y, -reach), (x, y, reach)]
    per = (columns + 1) * rows
    for i in range(columns):
        a = 2 * i
        faces += [(a, a + 1, a + 3, a + 2), (per + a, per + a + 2, per + a + 3, per + a + 1)]
        faces += [(a, a + 2, per + a + 2, per + a), (a + 1, per + a + 1, per + a + 3, a + 3)]
    faces += [(0, per, per + 1, 1), (per - 2, per - 1, 2 * per - 1, 2 * per - 2)]
    return add_faces("Pane", points, faces, surface)


def build(scene):
    wall = diffuse("Plaster", (0.72, 0.70, 0.66))
    plate("Floor", 0.0, 0.6, 3.0, 3.2, 0.0, diffuse("Concrete", (0.42, 0.42, 0.42)))
    add_faces("Wall", [(-1.5, 1.7, 0), (1.5, 1.7, 0), (1.5, 1.7, 1.6), (-1.5, 1.7, 1.6)], [(3, 2, 1, 0)], wall)
    mirror = metal("Mirror", (0.92, 0.92, 0.93), 0.0)
    inside = [(RADIUS * k / 48, (RADIUS * k / 48) ** 2 / (4 * FOCUS)) for k in range(49)]
    outside = [
        (RADIUS + 0.003, inside[-1][1]),
        *[(r + 0.003, z - 0.003) for r, z in reversed(inside[1:])],
        (0.0, -0.003),
    ]
    reflector = lathe("Reflector", [*inside, *outside], mirror, 128)
    reflector.location, reflector.rotation_euler = (0.0, 0.0, HEIGHT), (math.radians(-90), 0, 0)
    pane = ribbed_pane(glass("Pane", (0.99, 1.0, 1.0), 1.5))
    pane.location = (0.0, inside[-1][1] + 0.004, HEIGHT)
    filament, _ = material("Filament", "ShaderNodeEmission", Color=(1.0, 0.80, 0.52, 1), Strength=60000.0)
    block("Filament", (-0.0025, FOCUS - 0.0008, HEIGHT - 0.0008), (0.0025, FOCUS + 0.0008, HEIGHT + 0.0008), filament)
    block("Stand", (-0.05, -0.03, 0.0), (0.05, 0.02, HEIGHT - 0.095), diffuse("Stand", (0.10, 0.10, 0.12)), 0.004)
    fill = light("AREA", "Window", (-1.2, -0.6, 1.4), (0.0, 0.8, 0.3), 2.5, (0.6, 0.75, 1.0), size=0.8)
    aim(fill, (0.0, 0.8, 0.3))
    color_world(scene, (0.3, 0.4, 0.6), 0.02)
    camera((0.80, -0.72, 0.86), (-0.12, 0.85, 0.40), 28.0)
    set_up(scene, bounces=12)


if __name__ == "__main__":
    save(build)
