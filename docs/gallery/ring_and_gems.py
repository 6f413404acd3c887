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
    plate("Table", 0.0, 0.0, 0.6, 0.5, 0.0, varnished("Porcelain", (0.40, 0.35, 0.31), 0.5))
    # Straight inside, where it is to focus; edges of their own keep it so where normals are smooth.
    outside = ((0.0098, 0.0), (0.0102, 0.0004), (0.0105, 0.0022), (0.0102, 0.0040), (0.0098, 0.0044))
    band = [*outside, (0.0096, 0.0042), (0.0096, 0.0040), (0.0096, 0.0004), (0.0096, 0.0002)]
    ring = lathe("Ring", band, metal("Gold", (1.0, 0.70, 0.30), 0.0), 192)
    ring.location = (0.005, 0.003, 0.0001)
    rest = math.radians(41)
    stones = (
        ("Diamond", (1.0, 1.0, 1.0), 2.418, 55.0, 0.0110, (-0.0150, -0.0050), 0.4),
        ("Sapphire", (0.22, 0.40, 0.98), 1.768, 72.0, 0.0080, (0.0200, -0.0095), 1.3),
        ("Ruby", (0.98, 0.14, 0.24), 1.766, 72.0, 0.0070, (-0.0020, -0.0155), 2.2),
        ("Emerald", (0.16, 0.90, 0.44), 1.58, 72.0, 0.0078, (-0.0235, 0.0085), 2.9),
    )
    for name, color, index, abbe, width, (x, y), turn in stones:
        height = 0.5 * width * (0.86 * math.cos(rest) - 0.0) * 0.80
        surface = glass(name, color, index)
        surface.rppm.use_dispersion, surface.rppm.abbe_number = True, abbe
        brilliant(name, width, surface, (x, y, height), turn, rest)
    light(
        "SPOT",
        "Left Lamp",
        (-0.21, -0.03, 0.17),
        (0.0, -0.002, 0.0),
        2.6,
        (1.0, 0.90, 0.76),
        shadow_soft_size=0.0025,
        spot_size=math.radians(25),
        spot_blend=1.0,
    )
    light(
        "SPOT",
        "Right Lamp",
        (0.20, 0.14, 0.20),
        (0.0, -0.002, 0.0),
        0.55,
        (0.72, 0.85, 1.0),
        shadow_soft_size=0.0025,
        spot_size=math.radians(25),
        spot_blend=1.0,
    )
    light(
        "AREA",
        "Soft Box",
        (0.05, 0.10, 0.22),
        (0.0, 0.0, 0.0),
        0.06,
        (1.0, 1.0, 1.0),
        shape="RECTANGLE",
        size=0.20,
        size_y=0.06,
    )
    color_world(scene, (0.6, 0.65, 0.75), 0.05)
    camera((0.002, -0.092, 0.086), (-0.0005, -0.0030, 0.0012), 74.0)
    set_up(scene, bounces=12)


if __name__ == "__main__":
    save(build)
