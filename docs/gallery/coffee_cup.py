# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes coffee_cup.blend: the sun in a cup of steel draws its caustic on the coffee, and the spoon another one."""

import math

from stage import camera, color_world, diffuse, lathe, metal, plate, save, set_up, smooth_line, sun, torus, varnished

OUTER = ((0.0, 0.0), (0.026, 0.0), (0.030, 0.004), (0.038, 0.030), (0.041, 0.075))
INNER = ((0.0395, 0.075), (0.0365, 0.030), (0.028, 0.006), (0.0, 0.005))


def build(scene):
    plate("Table", 0.0, 0.0, 2.0, 1.4, 0.0, varnished("Wood", (0.30, 0.16, 0.08), 0.35))
    steel = metal("Steel", (0.86, 0.85, 0.83), 0.03)
    lathe("Cup", [*smooth_line(OUTER), *smooth_line(INNER)], steel, 192)
    handle = torus("Handle", 0.020, 0.0035, steel)
    handle.location, handle.rotation_euler = (0.053, 0.012, 0.040), (math.radians(90), 0, math.radians(13))
    milk = diffuse("Milk Coffee", (0.66, 0.46, 0.30))
    lathe("Coffee", [(0.0, 0.045), (0.0378, 0.045), (0.0, 0.040)], milk)
    china = varnished("China", (0.83, 0.81, 0.76), 0.08)
    saucer = ((0.0, -0.003), (0.045, -0.003), (0.075, 0.010), (0.0745, 0.0115), (0.044, -0.0012), (0.0, -0.0012))
    lathe("Saucer", smooth_line(saucer), china).location.z = 0.0035
    sun((0.62, 0.30, -0.58), 5.0)
    color_world(scene, (0.55, 0.66, 0.85), 0.35)
    camera((-0.03, -0.25, 0.31), (0.010, 0.0, 0.030), 52.0)
    set_up(scene)


if __name__ == "__main__":
    save(build)
