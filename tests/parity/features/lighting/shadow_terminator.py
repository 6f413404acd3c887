# SPDX-License-Identifier: GPL-3.0-or-later
"""The edge of shadows on smooth surfaces of few triangles."""

import bpy

from ...scenes import light, place
from .. import stage
from .lights import lights


def _coarse(geometry, shading, kind="SUN", energy=2.0, **properties):
    """A ball of few faces, lit from the side."""

    def make() -> None:
        old = bpy.data.objects["Ball"]
        ball = stage.ball(old.data.materials[0], segments=12)
        bpy.data.objects.remove(old)
        ball.shadow_terminator_geometry_offset = geometry
        ball.shadow_terminator_shading_offset = shading
        light(kind, energy, place(at=(3.0, -1.0, 1.6), turn=(0.0, 75.0, -10.0)), **properties)

    return make


lights("Shadow Terminator", "none", _coarse(0.0, 0.0, angle=0.0))
lights("Shadow Terminator", "geometry offset 0.1", _coarse(0.1, 0.0, angle=0.0))
lights("Shadow Terminator", "geometry offset 0.3", _coarse(0.3, 0.0, "POINT", 300.0, shadow_soft_size=0.1))
lights("Shadow Terminator", "shading offset 0.5", _coarse(0.0, 0.5, angle=0.0))
lights("Shadow Terminator", "both, area", _coarse(0.1, 0.3, "AREA", 300.0, size=0.5), effort=2)
