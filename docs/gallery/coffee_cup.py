# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes coffee_cup.blend: the sun in a cup of steel draws its caustic on the coffee."""

import math

from stage import (
    add_faces,
    camera,
    color_world,
    diffuse,
    lathe,
    metal,
    plate,
    save,
    set_up,
    smooth_line,
    sun,
    torus,
    varnished,
    wood,
)

OUTER = ((0.0, 0.0), (0.026, 0.0), (0.030, 0.004), (0.038, 0.030), (0.041, 0.075))
INNER = ((0.0395, 0.075), (0.0365, 0.030), (0.028, 0.006), (0.0, 0.005))


def spoon(surface):
    """Along X, bowl at its end."""
    outside = ((0.0, 0.0), (0.006, 0.0006), (0.0115, 0.0035), (0.013, 0.0060))
    inside = ((0.0122, 0.0060), (0.0108, 0.0040), (0.0056, 0.0013), (0.0, 0.0008))
    bowl = lathe("Spoon", [*smooth_line(outside), *smooth_line(inside)], surface, 96)
    bowl.scale.x = 1.5
    points, faces, steps = [], [], 24
    for k in range(steps + 1):
        t = k / steps
        x, z = 0.0175 + 0.085 * t, 0.0052 + 0.012 * math.sin(0.5 * math.pi * t) - 0.004 * t * t
        half = 0.0022 + 0.0032 * t * t
        points += [(x, -half, z), (x, half, z), (x, half, z + 0.0011), (x, -half, z + 0.0011)]
    for k in range(steps):
        faces += [(4 * k + i, 4 * k + (i + 1) % 4, 4 * k + 4 + (i + 1) % 4, 4 * k + 4 + i) for i in range(4)]
    handle = add_faces(
        "Handle", points, [(0, 1, 2, 3), tuple(range(4 * steps + 3, 4 * steps - 1, -1)), *faces], surface
    )
    handle.parent = bowl
    return bowl


def build(scene):
    plate("Table", 0.0, 0.0, 2.0, 1.4, 0.0, wood("Walnut", (0.055, 0.026, 0.013), (0.21, 0.105, 0.05), 0.3, 12.0, 2.2))
    steel = metal("Steel", (0.90, 0.88, 0.85), 0.03)
    cup = lathe("Cup", [*smooth_line(OUTER), *smooth_line(INNER)], steel, 192)
    ear = torus("Ear", 0.020, 0.0035, steel)
    ear.location, ear.rotation_euler = (0.053, 0.012, 0.042), (math.radians(90), 0, math.radians(13))
    coffee = lathe("Coffee", [(0.0, 0.058), (0.0386, 0.058), (0.0, 0.053)], diffuse("Milk Coffee", (0.46, 0.28, 0.16)))
    cup.location.z = coffee.location.z = 0.0026
    china = varnished("China", (0.50, 0.52, 0.53), 0.08)
    saucer = ((0.0, -0.003), (0.045, -0.003), (0.075, 0.010), (0.0745, 0.0115), (0.044, -0.0012), (0.0, -0.0012))
    lathe("Saucer", smooth_line(saucer), china).location.z = 0.0035
    rest = spoon(steel)
    rest.location, rest.rotation_euler = (-0.043, -0.042, 0.0062), (0, math.radians(-3), math.radians(-26))
    sun((0.62, 0.20, -0.60), 3.4, (1.0, 0.88, 0.72))
    color_world(scene, (0.50, 0.64, 0.90), 0.16)
    camera((-0.035, -0.27, 0.255), (0.018, -0.006, 0.030), 43.0)
    set_up(scene)


if __name__ == "__main__":
    save(build)
