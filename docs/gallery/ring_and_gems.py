# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes ring_and_gems.blend: a gold ring and cut stones under two small lamps."""

import math

from stage import add_faces, camera, color_world, glass, lathe, light, metal, plate, save, set_up, varnished


def brilliant(name, width, surface, place, turn, tilt=0.0, sides=16):
    """A stone with a table, a crown, a girdle and a pavilion."""
    ring = lambda radius, height, shift, count: [  # noqa: E731
        (radius * math.cos(math.tau * (k + shift) / count), radius * math.sin(math.tau * (k + shift) / count), height)
        for k in range(count)
    ]
    half = width / 2
    rings = [
        ring(0.56 * half, 0.30 * half, 0.5, sides // 2),
        ring(half, 0.03 * half, 0.0, sides),
        ring(half, -0.02 * half, 0.0, sides),
    ]
    points = [point for level in rings for point in level] + [(0.0, 0.0, -0.86 * half)]
    table, top, low, tip = 0, sides // 2, sides // 2 + sides, len(points) - 1
    faces = [tuple(range(sides // 2))]
    for k in range(sides // 2):
        a, b = table + k, table + (k + 1) % (sides // 2)
        p, q, r = (top + (2 * k + j) % sides for j in (0, 1, 2))
        faces += [(a, p, q), (a, q, b), (b, q, r)]
    for k in range(sides):
        a, b = k, (k + 1) % sides
        faces += [(top + a, low + a, low + b, top + b), (low + a, tip, low + b)]
    made = add_faces(name, points, faces, surface)
    made.location, made.rotation_euler = place, (tilt, 0.0, turn - 0.6)
    return made


def build(scene):
    plate("Table", 0.0, 0.0, 0.6, 0.5, 0.0, varnished("Slate", (0.42, 0.40, 0.41), 0.4))
    gold = metal("Gold", (1.0, 0.74, 0.34), 0.04)
    band = [(0.0098, 0.0), (0.0105, 0.0004), (0.0109, 0.0025), (0.0105, 0.0046), (0.0098, 0.0050), (0.0094, 0.0025)]
    ring = lathe("Ring", band, gold, 192)
    ring.location = (0.006, 0.004, 0.0002)
    rest = math.radians(41)
    stones = (
        ("Diamond", (1.0, 1.0, 1.0), 2.418, 0.0105, (-0.016, -0.006), 0.4),
        ("Sapphire", (0.25, 0.42, 0.98), 1.768, 0.0080, (0.022, -0.011), 1.3),
        ("Ruby", (0.98, 0.16, 0.24), 1.766, 0.0070, (-0.004, -0.017), 2.2),
        ("Emerald", (0.20, 0.88, 0.46), 1.58, 0.0075, (-0.026, 0.011), 2.9),
    )
    for name, color, index, width, (x, y), turn in stones:
        height = 0.5 * width * (0.86 * math.cos(rest) - 0.0) * 0.80
        brilliant(name, width, glass(name, color, index), (x, y, height), turn, rest)
    light("SPOT", "Left Lamp", (-0.16, 0.10, 0.20), (0.0, 0.0, 0.0), 0.8, (1.0, 0.93, 0.82), shadow_soft_size=0.004,
          spot_size=math.radians(24), spot_blend=0.4)  # fmt: skip
    light("SPOT", "Right Lamp", (0.20, 0.06, 0.16), (0.0, 0.0, 0.0), 0.45, (0.85, 0.92, 1.0), shadow_soft_size=0.004,
          spot_size=math.radians(24), spot_blend=0.4)  # fmt: skip
    color_world(scene, (0.6, 0.65, 0.75), 0.10)
    camera((0.004, -0.088, 0.066), (-0.002, -0.003, 0.003), 66.0)
    set_up(scene, bounces=12)


if __name__ == "__main__":
    save(build)
