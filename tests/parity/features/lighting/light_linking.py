# SPDX-License-Identifier: GPL-3.0-or-later
"""Light linking: the objects that lights shine on, and the objects that cast shadows in their light."""

import bpy

from ...net import material
from ...scenes import light, place
from .. import stage
from .light_limits import second_lamp
from .lights import ABOVE, lights


def _collection(*states: tuple[str, str], child: str = "") -> bpy.types.Collection:
    """Return a collection of objects with their link states, or one with these in a child whose state is ``child``."""
    made = inner = bpy.data.collections.new("Linked")
    if child:
        inner = bpy.data.collections.new("Within")
        made.children.link(inner)
        made.collection_children[0].light_linking.link_state = child
    for name, state in states:
        inner.objects.link(bpy.data.objects[name])
        inner.collection_objects[-1].light_linking.link_state = state
    return made


def _lamp(kind="POINT", energy=60.0, **properties):
    return lambda: light(kind, energy, place(**ABOVE), **properties)


def _glow() -> bpy.types.Object:
    surface, net = material("Glow")
    net.output(net.emission((1.0, 0.8, 0.6), 10.0))
    made = stage.ground(surface, 0.7, {"at": (0.6, -0.5, 2.6), "turn": (170.0, 15.0, 0.0)})
    made.name = "Glow"
    return made


def _linked(make, member, *states, child=""):
    def build() -> None:
        emitter = make()
        setattr(emitter.light_linking, member, _collection(*states, child=child))
        second_lamp()

    return build


RECEIVERS, BLOCKERS = "receiver_collection", "blocker_collection"
BALL_IN, BALL_OUT, GROUND_IN = ("Ball", "INCLUDE"), ("Ball", "EXCLUDE"), ("Ground", "INCLUDE")
SMALL = {"shadow_soft_size": 0.1}
LINKS = {
    "Light Linking": {
        "on the ball only": _linked(_lamp(**SMALL), RECEIVERS, BALL_IN),
        "not on the ball": _linked(_lamp(**SMALL), RECEIVERS, BALL_OUT),
        "sun, not on a collection": _linked(_lamp("SUN", 2.0, angle=0.1), RECEIVERS, BALL_IN, child="EXCLUDE"),
        "area, on the ball only": _linked(_lamp("AREA", size=0.8), RECEIVERS, BALL_IN),
        "glowing mesh, on the ground only": _linked(_glow, RECEIVERS, GROUND_IN),
        "an empty collection": _linked(_lamp(**SMALL), RECEIVERS),
    },
    "Shadow Linking": {
        "not of the ball": _linked(_lamp(**SMALL), BLOCKERS, BALL_OUT),
        "of the ground only": _linked(_lamp("SUN", 2.0, angle=0.1), BLOCKERS, GROUND_IN),
        "area, not of the ball": _linked(_lamp("AREA", size=0.8), BLOCKERS, BALL_OUT),
        "glowing mesh, not of the ball": _linked(_glow, BLOCKERS, BALL_OUT),
    },
}  # fmt: skip


def _seen_in(roughness: float):
    """A glowing mesh that does not shine on the ground, which reflects it."""

    def make() -> None:
        _linked(_glow, RECEIVERS, BALL_IN)()
        mirror, net = material("Mirror")
        net.output(net.out("BsdfAnisotropic", inputs={"Color": (0.8, 0.8, 0.8), "Roughness": roughness}))
        bpy.data.objects["Ground"].data.materials[0] = mirror

    return make


LINKS["Light Linking"]["glowing mesh, not on a mirror"] = _seen_in(0.0)
LINKS["Light Linking"]["glowing mesh, not on a glossy ground"] = _seen_in(0.3)
for _group, _rows in LINKS.items():
    for _name, _make in _rows.items():
        lights(_group, _name, _make, effort=2 if "glowing" in _name or "area" in _name else 1)
