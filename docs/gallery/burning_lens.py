# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes burning_lens.blend: a magnifying glass focuses the sun on an old letter."""

import math

from stage import (
    Matrix,
    add_faces,
    camera,
    color_world,
    diffuse,
    lathe,
    material,
    metal,
    plate,
    save,
    set_up,
    sun,
    torus,
    varnished,
)  # fmt: skip

RADIUS, CURVATURE = 0.045, 0.105
TILT = Matrix.Rotation(math.radians(-31), 4, "X") @ Matrix.Rotation(math.radians(14), 4, "Y")
PLACE = Matrix.Translation((0.0, 0.03, 0.083))


def lens_profile(steps=32):
    """A biconvex lens with a small rim."""
    sagitta = CURVATURE - math.sqrt(CURVATURE**2 - RADIUS**2)
    front = []
    for k in range(steps + 1):
        r = RADIUS * k / steps
        front.append((r, math.sqrt(CURVATURE**2 - r * r) - CURVATURE + sagitta + 0.001))
    return [(r, -z) for r, z in front] + [(r, z) for r, z in reversed(front)]


def build(scene):
    plate("Desk", 0.0, 0.1, 2.0, 1.4, 0.0, varnished("Desk", (0.16, 0.075, 0.04), 0.3))
    letter = plate("Letter", 0.0, 0.0, 0.30, 0.22, 0.0012, diffuse("Paper", (0.78, 0.70, 0.54)))
    letter.rotation_euler.z = math.radians(-12)
    ink = diffuse("Ink", (0.05, 0.04, 0.06))
    for line in range(13):
        y, x = 0.088 - 0.0145 * line, -0.125
        word = 0
        while x < 0.11 - 0.03 * (line % 4 == 3):
            length = 0.012 + 0.016 * ((line * 7 + word * 5) % 4) / 3
            made = add_faces(
                "Word",
                [(x, y, 0), (x + length, y, 0), (x + length, y + 0.0032, 0), (x, y + 0.0032, 0)],
                [(0, 1, 2, 3)],
                ink,
            )
            made.matrix_world = letter.matrix_basis @ Matrix.Translation((0, 0, 0.0014))
            x, word = x + length + 0.006, word + 1
    clear, _ = material("Lens", "ShaderNodeBsdfGlass", Color=(0.99, 1.0, 0.99, 1), Roughness=0.0, IOR=1.52)
    brass = metal("Brass", (0.95, 0.76, 0.40), 0.08)
    lens = lathe("Lens", lens_profile(), clear, 160)
    rim = torus("Rim", RADIUS + 0.0022, 0.0028, brass)
    rod = [(0.0, 0.0), (0.0035, 0.0), (0.0045, 0.02), (0.0075, 0.03), (0.0085, 0.06), (0.007, 0.10), (0.0, 0.104)]
    handle = lathe("Handle", rod, varnished("Handle", (0.05, 0.02, 0.015), 0.1))
    lens.matrix_world = rim.matrix_world = PLACE @ TILT
    handle.matrix_world = (
        PLACE @ TILT @ Matrix.Rotation(math.radians(-35), 4, "Z") @ Matrix.Translation((RADIUS + 0.004, 0, 0))
        @ Matrix.Rotation(math.radians(90), 4, "Y")
    )  # fmt: skip
    sun((0.24, -0.48, -0.85), 3.5)
    color_world(scene, (0.55, 0.62, 0.75), 0.25)
    camera((-0.13, -0.30, 0.40), (0.022, 0.012, 0.02), 50.0)
    set_up(scene)


if __name__ == "__main__":
    save(build)
