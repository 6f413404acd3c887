# SPDX-License-Identifier: GPL-3.0-or-later
"""What light is kept from: shadows that it does not cast, surfaces that it is not scattered by, rays that see no
world."""

import bpy

from ..scenes import light, place
from .lights import ABOVE, lights
from .net import material
from .worlds import world


def _second() -> None:
    """A weak light without limits, from the other side."""
    light("POINT", 12.0, place(at=(-1.5, -1.5, 2.0)), shadow_soft_size=0.1, color=(0.4, 0.7, 1.0))


def _without_shadow(kind, energy=60.0, **properties):
    def make() -> None:
        light(kind, energy, place(**ABOVE), use_shadow=False, **properties)
        _second()

    return make


lights("Cast Shadow", "off, point", _without_shadow("POINT", shadow_soft_size=0.0))
lights("Cast Shadow", "off, sun", _without_shadow("SUN", 2.0, angle=0.0))
lights("Cast Shadow", "off, area", _without_shadow("AREA", size=0.8))


def _bright() -> None:
    """White surfaces, which scatter light often."""
    white, net = material("White")
    net.output(net.out("BsdfDiffuse", inputs={"Color": (0.9, 0.85, 0.8)}))
    for name in ("Ball", "Ground"):
        bpy.data.objects[name].data.materials[0] = white


def _limited(kind, bounces, energy=60.0, **properties):
    def make() -> None:
        light(kind, energy, place(**ABOVE), **properties).data.cycles.max_bounces = bounces
        _bright()

    return make


lights("Max Bounces", "point, 0", _limited("POINT", 0, shadow_soft_size=0.1))
lights("Max Bounces", "sun, 1", _limited("SUN", 1, 2.0, angle=0.1))
lights("Max Bounces", "area, 1", _limited("AREA", 1, size=0.8))


def _spot(bounces):
    """A world of one bright spot, of which Cycles' rays that happen to meet it, and ask for no bounces, know little."""

    def feed(net):
        bpy.context.scene.world.cycles.max_bounces = bounces
        _bright()
        along = net.out("VectorMath", "Value", {0: net.out("TexCoord", "Generated"), 1: (0.5, -0.5, 0.707)},
                        operation="DOT_PRODUCT")  # fmt: skip
        spot = net.out("Math", 0, {0: along, 1: 0.97}, operation="GREATER_THAN")
        return (1.0, 0.9, 0.8), net.out("Math", 0, {0: spot, 1: 30.0}, operation="MULTIPLY")

    return feed


SAMPLED = {"reason": "Cycles leaves in what its rays find of the world by chance", "mean": 0.03, "block": 0.05}


def _even(bounces):
    def feed(net):
        bpy.context.scene.world.cycles.max_bounces = bounces
        _bright()
        return (0.5, 0.55, 0.6), 1.0

    return feed


world("Max Bounces", "world with a bright spot, 0", _spot(0), **SAMPLED)
world("Max Bounces", "even world, 0", _even(0))


def _hidden(*kinds, even=True, shiny=False):
    """A world that rays of some kinds do not see, perhaps about a ball that reflects."""

    def feed(net):
        for kind in kinds:
            setattr(bpy.context.scene.world.cycles_visibility, kind, False)
        if shiny:
            glossy, nodes = material("Shiny")
            nodes.output(nodes.out("BsdfAnisotropic", inputs={"Color": 0.8, "Roughness": 0.35}, distribution="GGX"))
            bpy.data.objects["Ball"].data.materials[0] = glossy
        color = (0.5, 0.55, 0.6) if even else net.scaled(net.out("TexCoord", "Generated"), 0.5, 0.5)
        return color, 1.0

    return feed


def _glass(net):
    return net.out("BsdfGlass", inputs={"Color": 0.9, "Roughness": 0.0, "IOR": 1.3})


def _principled(net):
    return net.out("BsdfPrincipled", inputs={"Base Color": (0.6, 0.4, 0.3, 1.0), "Roughness": 0.3})


VISIBILITY = "Ray Visibility of the world"
world(VISIBILITY, "hidden from the camera", _hidden("camera"), _principled, effort=2)
for _kind, _name in (("diffuse", "diffuse surfaces"), ("glossy", "reflections")):
    world(VISIBILITY, f"hidden from {_name}", _hidden(_kind, shiny=True), effort=2)
    world(VISIBILITY, f"with colors, hidden from {_name}", _hidden(_kind, even=False, shiny=True), effort=2)
world(VISIBILITY, "hidden from transmission", _hidden("transmission"), _glass, effort=2)
MIXED = "Cycles takes a ray for that of the part which chose it, and lets all parts of a material count"
world(VISIBILITY, "hidden from diffuse parts", _hidden("diffuse"), _principled, effort=2, reason=MIXED, mean=0.03)
