# SPDX-License-Identifier: GPL-3.0-or-later
"""Lights of each kind with their options, and meshes that glow."""

import math

from ..scenes import light, place
from . import stage
from .image_textures import texture
from .net import Net, material
from .rows import Row, add

ABOVE = {"at": (0.7, -0.9, 2.8), "turn": (15.0, 20.0, 0.0)}


def lamps(group: str, name: str, make, **members: object) -> None:
    """A row of a lamp over a grey ball on a grey ground."""

    def build() -> None:
        stage.empty()
        plain, net = material("Plain")
        net.output(net.out("BsdfDiffuse", inputs={"Color": (0.6, 0.55, 0.5)}))
        stage.set_up(plain)
        make()

    add(Row(group, name, build, **members))


def _lamp(kind, energy=60.0, where=None, **properties):
    return lambda: light(kind, energy, place(**(where or ABOVE)), **properties)


LAMPS = {
    "Point Light": {
        "no size": ("POINT", {"shadow_soft_size": 0.0}), "size 0.4": ("POINT", {"shadow_soft_size": 0.4}),
        "size 0.4, no soft falloff": ("POINT", {"shadow_soft_size": 0.4, "use_soft_falloff": False}),
        "temperature": ("POINT", {"use_temperature": True, "temperature": 3000.0}),
        "exposure": ("POINT", {"exposure": 1.2, "color": (1.0, 0.6, 0.3)}),
        "not normalized": ("POINT", {"energy": 20.0, "normalize": False, "shadow_soft_size": 0.5}),
    },
    "Spot Light": {
        "blend 0.5": ("SPOT", {"spot_size": math.radians(60.0), "spot_blend": 0.5, "shadow_soft_size": 0.0}),
        "blend 0": ("SPOT", {"spot_size": math.radians(50.0), "spot_blend": 0.0, "shadow_soft_size": 0.05}),
        "blend 1, wide": ("SPOT", {"spot_size": math.radians(120.0), "spot_blend": 1.0, "shadow_soft_size": 0.3}),
    },
    "Sun": {
        "no size": ("SUN", {"energy": 2.0, "angle": 0.0}), "20 degrees": ("SUN", {"energy": 2.0, "angle": 0.35}),
        "not normalized": ("SUN", {"energy": 30.0, "angle": 0.3, "normalize": False}),
    },
    "Area Light": {
        "square": ("AREA", {"size": 0.8}),
        "rectangle": ("AREA", {"shape": "RECTANGLE", "size": 0.5, "size_y": 1.6}),
        "disk": ("AREA", {"shape": "DISK", "size": 1.0}),
        "ellipse": ("AREA", {"shape": "ELLIPSE", "size": 0.5, "size_y": 1.4}),
        "spread 60 degrees": ("AREA", {"size": 0.8, "spread": math.radians(60.0)}),
        "not normalized": ("AREA", {"energy": 25.0, "size": 1.2, "normalize": False}),
    },
}  # fmt: skip
for _group, _rows in LAMPS.items():
    for _name, (_kind, _properties) in _rows.items():
        lamps(_group, _name, _lamp(_kind, **_properties), effort=2 if "spread" in _properties else 1)


def _with_nodes(kind, feed, **properties):
    """A lamp whose emission is fed by ``feed(net)``: colour and strength."""

    def make() -> None:
        made = light(kind, 60.0, place(**ABOVE), **properties)
        if made.data.node_tree is None or not made.data.use_nodes:
            made.data.use_nodes = True
        tree = made.data.node_tree
        tree.nodes.clear()
        net = Net(tree)
        color, strength = feed(net)
        net.tree.links.new(net.emission(color, strength), net.node("OutputLight").inputs[0])

    return make


lamps("Light nodes", "constant", _with_nodes("POINT", lambda net: ((0.4, 0.8, 1.0), 1.5), shadow_soft_size=0.1))
lamps(
    "Light nodes", "blackbody", _with_nodes("AREA", lambda net: (net.out("Blackbody", 0, {0: 3200.0}), 1.0), size=0.8)
)
lamps(
    "Light nodes",
    "quadratic falloff",
    _with_nodes(
        "POINT",
        lambda net: ((1.0, 1.0, 1.0), net.out("LightFalloff", "Quadratic", {"Strength": 1.0})),
        shadow_soft_size=0.1,
    ),
)
lamps(
    "Light nodes",
    "smooth quadratic falloff",
    _with_nodes(
        "POINT",
        lambda net: ((1.0, 1.0, 1.0), net.out("LightFalloff", "Quadratic", {"Strength": 1.0, "Smooth": 1.0})),
        shadow_soft_size=0.1,
    ),
)
lamps(
    "Light nodes",
    "linear falloff",
    _with_nodes(
        "POINT",
        lambda net: ((1.0, 1.0, 1.0), net.out("LightFalloff", "Linear", {"Strength": 0.4})),
        shadow_soft_size=0.1,
    ),
)
lamps(
    "Light nodes",
    "constant falloff",
    _with_nodes(
        "AREA", lambda net: ((1.0, 1.0, 1.0), net.out("LightFalloff", "Constant", {"Strength": 0.2})), size=0.8
    ),
)
lamps(
    "Light nodes",
    "IES-like, by direction",
    _with_nodes(
        "SPOT",
        lambda net: ((1.0, 1.0, 1.0), net.out("TexGradient", "Fac", {0: net.out("TexCoord", "Normal")})),
        shadow_soft_size=0.0,
        spot_size=2.0,
    ),
    warns=True,
    mean=1.0,
    block=3.0,
    reason="nodes of lamps that vary by direction give one value",
)


def _two() -> None:
    _lamp("POINT", 30.0, shadow_soft_size=0.1, color=(1.0, 0.5, 0.2))()
    _lamp("AREA", 40.0, {"at": (-1.5, -1.0, 2.0), "turn": (30.0, -40.0, 0.0)}, size=0.6, color=(0.3, 0.6, 1.0))()


lamps("Lights", "two of them", _two)


def _glowing(feed, half=0.7):
    """A glowing square over the scene, fed by ``feed(net)``: colour and strength."""

    def make() -> None:
        surface, net = material("Glow")
        net.output(net.emission(*feed(net)))
        stage.ground(surface, half, {"at": (0.6, -0.5, 2.6), "turn": (170.0, 15.0, 0.0)})

    return make


lamps("Glowing mesh", "plain", _glowing(lambda net: ((1.0, 0.8, 0.6), 10.0)), effort=2)
lamps("Glowing mesh", "strength by an image", _glowing(lambda net: (texture(kind="opaque")(net), 20.0)), effort=2)
lamps(
    "Glowing mesh",
    "strength by a checker",
    _glowing(
        lambda net: (
            (1.0, 0.9, 0.8),
            net.out("Math", 0, {0: net.out("TexChecker", "Fac", {"Scale": 2.0}), 1: 20.0}, operation="MULTIPLY"),
        )
    ),
    effort=2,
)
lamps(
    "Glowing mesh",
    "one side only",
    _glowing(
        lambda net: (
            (1.0, 0.9, 0.8),
            net.out("Math", 0, {0: net.out("NewGeometry", "Backfacing"), 1: -12.0, 2: 12.0}, operation="MULTIPLY_ADD"),
        )
    ),
    effort=2,
)
lamps(
    "Glowing mesh",
    "by a ramp of noise",
    _glowing(lambda net: (net.out("ValToRGB", 0, {0: net.out("TexNoise", "Fac", {"Scale": 5.0})}), 20.0)),
    effort=2,
)


def _small_bulbs() -> None:
    surface, net = material("Bulb")
    net.output(net.emission((1.0, 0.8, 0.6), 60.0))
    for x, y in ((1.5, -1.2), (-1.4, -1.0)):
        stage.ball(surface, {"at": (x, y, 2.9), "scale": (0.18, 0.18, 0.18)}, 12)


lamps("Glowing mesh", "two bulbs", _small_bulbs, effort=2)


def _unseen() -> None:
    made = _lamp("AREA", 60.0, {"at": (0.0, 0.9, 1.9), "turn": (-40.0, 0.0, 0.0)}, size=0.8)()
    made.visible_camera = False


lamps(
    "Area Light", "in view", _lamp("AREA", 60.0, {"at": (0.0, 1.2, 2.2), "turn": (-40.0, 0.0, 0.0)}, size=0.8), effort=3
)
lamps("Area Light", "hidden from the camera", _unseen, effort=3)
