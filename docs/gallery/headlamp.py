# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes headlamp.blend: a car's headlamp, whose mirror and ribbed glass throw the light of a filament on the floor."""

import math

from stage import (
    Vector,
    add_faces,
    ball,
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
    smooth_line,
    torus,
    varnished,
)

FOCUS, RADIUS, HEIGHT = 0.032, 0.085, 0.13
DIP = math.radians(13)
"""How far the lamp looks down."""
FILAMENT = 40000.0


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
    plate("Floor", 0.0, 1.0, 6.0, 6.0, 0.0, diffuse("Concrete", (0.27, 0.265, 0.26)))
    black = varnished("Black", (0.012, 0.012, 0.014), 0.25)
    inside = [(RADIUS * k / 48, (RADIUS * k / 48) ** 2 / (4 * FOCUS)) for k in range(49)]
    outside = [
        (RADIUS + 0.003, inside[-1][1]),
        *[(r + 0.003, z - 0.003) for r, z in reversed(inside[1:])],
        (0.0, -0.003),
    ]
    depth = inside[-1][1]
    parts = [lathe("Reflector", [*inside, *outside], metal("Mirror", (0.92, 0.92, 0.93), 0.0), 128)]
    shell = (
        (0.0, -0.022),
        (0.045, -0.018),
        (0.078, 0.020),
        (0.096, 0.055),
        (0.0975, 0.074),
        (0.089, 0.074),
        (0.0885, 0.05),
    )
    parts.append(lathe("Shell", [*smooth_line(shell), (0.0, -0.010)], black, 128))
    rim = torus("Rim", RADIUS + 0.0075, 0.0055, metal("Chrome", (0.85, 0.85, 0.86), 0.04))
    rim.location.z = depth + 0.006
    pane = ribbed_pane(glass("Pane", (0.99, 1.0, 1.0), 1.5))
    pane.location, pane.rotation_euler = (0.0, 0.0, depth + 0.003), (math.radians(90), 0, math.radians(180))
    filament, _ = material("Filament", "ShaderNodeEmission", Color=(1.0, 0.78, 0.50, 1), Strength=FILAMENT)
    half = 0.0008
    parts += [rim, pane, block("Filament", (-0.0025, -half, FOCUS - half), (0.0025, half, FOCUS + half), filament)]
    seat = add_faces("Seat", [], [], black)
    seat.location = (0.0, 0.0, HEIGHT)
    seat.rotation_euler = Vector((0.0, -math.cos(DIP), -math.sin(DIP))).to_track_quat("Z", "Y").to_euler()
    for part in parts:
        part.parent = seat
    block("Stand", (-0.03, 0.01, 0.0), (0.03, 0.05, HEIGHT - 0.05), black, 0.004)
    steel = metal("Steel", (0.75, 0.75, 0.77), 0.03)
    for number, (x, y, radius) in enumerate(((-0.10, -0.33, 0.016), (0.035, -0.37, 0.011), (-0.055, -0.385, 0.008))):
        ball(f"Steel Ball {number}", (x, y, radius), radius, steel)
    light(
        "AREA",
        "Window",
        (-1.0, 0.9, 1.0),
        (0.0, 0.0, 0.1),
        6.0,
        (0.45, 0.65, 1.0),
        shape="RECTANGLE",
        size=0.5,
        size_y=1.0,
    )
    color_world(scene, (0.3, 0.4, 0.6), 0.03)
    camera((0.40, -0.80, 0.36), (0.0, -0.19, 0.07), 41.0)
    set_up(scene, bounces=12)


if __name__ == "__main__":
    save(build)
