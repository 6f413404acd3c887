# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes prism.blend: a flat beam of white light goes through a prism of flint glass."""

import math

from stage import Vector, add_faces, block, camera, color_world, diffuse, glass, light, save, set_up, slit, varnished

INDEX, ABBE, SIDE, HEIGHT = 1.785, 26.0, 0.085, 0.042
INCIDENCE = math.asin(INDEX * math.sin(math.radians(30)))
TURNS_BY = 2 * INCIDENCE - math.radians(60)
"""What the prism turns yellow light by, the least that it can: then light crosses it parallel to its base."""


def prism(surface):
    """Upright on its triangle, apex along +Y, edges cut off a little."""
    cut, middle = 0.03 * SIDE, SIDE / math.sqrt(12)
    corners = [Vector((0, 2 * middle, 0)), Vector((-SIDE / 2, -middle, 0)), Vector((SIDE / 2, -middle, 0))]
    outline = []
    for k, corner in enumerate(corners):
        before, after = corners[k - 1], corners[(k + 1) % 3]
        outline += [corner + (before - corner).normalized() * cut, corner + (after - corner).normalized() * cut]
    points = [(p.x, p.y, z) for z in (0.0004, HEIGHT) for p in outline]
    count = len(outline)
    sides = [(k, (k + 1) % count, (k + 1) % count + count, k + count) for k in range(count)]
    return add_faces("Prism", points, [tuple(reversed(range(count))), tuple(range(count, 2 * count)), *sides], surface)


def build(scene):
    add_faces(
        "Slate", [(-2, -2, 0), (2, -2, 0), (2, 2, 0), (-2, 2, 0)], [(0, 1, 2, 3)], diffuse("Slate", (0.20, 0.20, 0.215))
    )
    flint = glass("Flint Glass", (1.0, 1.0, 1.0), INDEX)
    flint.rppm.use_dispersion, flint.rppm.abbe_number = True, ABBE
    prism(flint)
    # Through the middles of the sides on the left and right of the apex.
    crossing = SIDE / math.sqrt(12) / 2
    half = 0.5 * TURNS_BY
    upward = Vector((math.cos(half), math.sin(half), 0.0))
    entry = Vector((-SIDE / 4, crossing, 0.0))
    lamp = entry - upward * 0.26
    slit("Slit Lamp", lamp.xy, upward.xy, 1.1, (1.0, 1.0, 1.0), 0.0035, 0.036, 0.80, 0.35)
    turn = math.atan2(upward.y, upward.x)
    housing = block(
        "Housing", (-0.10, -0.022, 0.0), (-0.002, 0.022, 0.055), varnished("Black", (0.02, 0.02, 0.022), 0.3), 0.002
    )
    housing.location, housing.rotation_euler.z = lamp, turn
    # Where the upper side mirrors it to the camera.
    light(
        "AREA",
        "Window",
        (0.03, 0.60, 0.56),
        (0.0, 0.0, 0.04),
        2.2,
        (0.62, 0.78, 1.0),
        shape="RECTANGLE",
        size=0.5,
        size_y=0.3,
    )
    color_world(scene, (0.45, 0.6, 1.0), 0.05)
    camera((0.03, -0.52, 0.42), (0.035, -0.035, 0.0), 36.0)
    set_up(scene, bounces=10, look="AgX - Punchy")


if __name__ == "__main__":
    save(build)
