# SPDX-License-Identifier: GPL-3.0-or-later
"""Limits of lights: shadows that a light does not cast, and surfaces that do not scatter it."""

import bpy

from ...net import diffuse
from ...scenes import light, place
from .lights import ABOVE, lights


def second_lamp() -> None:
    """A weak light, without limits and links, from the other side."""
    light("POINT", 12.0, place(at=(-1.5, -1.5, 2.0)), shadow_soft_size=0.1, color=(0.4, 0.7, 1.0))


def _without_shadow(kind, energy=60.0, **properties):
    def make() -> None:
        light(kind, energy, place(**ABOVE), use_shadow=False, **properties)
        second_lamp()

    return make


lights("Cast Shadow", "off, point", _without_shadow("POINT", shadow_soft_size=0.0))
lights("Cast Shadow", "off, sun", _without_shadow("SUN", 2.0, angle=0.0))
lights("Cast Shadow", "off, area", _without_shadow("AREA", size=0.8))


def brighten() -> None:
    """White surfaces, which scatter light often."""
    white = diffuse("White", (0.9, 0.85, 0.8))
    for name in ("Ball", "Ground"):
        bpy.data.objects[name].data.materials[0] = white


def _limited(kind, bounces, energy=60.0, **properties):
    def make() -> None:
        light(kind, energy, place(**ABOVE), **properties).data.cycles.max_bounces = bounces
        brighten()

    return make


lights("Max Bounces", "point, 0", _limited("POINT", 0, shadow_soft_size=0.1))
lights("Max Bounces", "sun, 1", _limited("SUN", 1, 2.0, angle=0.1))
lights("Max Bounces", "area, 1", _limited("AREA", 1, size=0.8))
