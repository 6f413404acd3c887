# SPDX-License-Identifier: GPL-3.0-or-later
"""Lights of each kind with their options, and meshes that glow."""

import math

import numpy as np

from rppm_addon.scene import DirectLight, Instancing

from ...net import Net, diffuse, material, socket
from ...scenes import light, link_object, place
from .. import stage
from ..rows import Row, add
from ..values.image_textures import texture

IN_VIEW = {"at": (1.25, 0.6, 1.2), "turn": (-70.0, 10.0, 20.0)}
"""Beside the ball, toward the camera."""
ABOVE = {"at": (0.7, -0.9, 2.8), "turn": (15.0, 20.0, 0.0)}


def lights(group: str, name: str, make, **members: object) -> None:
    """A row of a light over a gray ball on a gray ground."""

    def build() -> None:
        stage.empty()
        stage.set_up(diffuse("Plain", (0.6, 0.55, 0.5)))
        make()

    add(Row(group, name, build, **members))


def _light(kind, energy=60.0, where=None, **properties):
    return lambda: light(kind, energy, place(**(where or ABOVE)), **properties)


LIGHTS = {
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
for _group, _rows in LIGHTS.items():
    for _name, (_kind, _properties) in _rows.items():
        lights(_group, _name, _light(_kind, **_properties), effort=2 if "spread" in _properties else 1)


def _sheared_spot(energy: float = 60.0, **properties: object) -> None:
    """A spot that turns within a parent of uneven scale, which shears it."""
    made = light("SPOT", energy, place(turn=(-20.0, 25.0, 30.0)), **properties)
    uneven = place(at=(0.7, -0.9, 2.8), turn=(25.0, 0.0, 20.0), scale=(1.3, 0.7, 1.0))
    made.parent = link_object(None, uneven, "Parent")


lights("Spot Light", "sheared", lambda: _sheared_spot(spot_size=1.0, spot_blend=0.2, shadow_soft_size=0.05))


def light_with_nodes(kind, feed, where=None, **properties):
    """A light whose emission is fed by ``feed(net)``: color and strength; the camera sees it where a place is given."""

    def make() -> None:
        made = light(kind, 60.0, place(**(where or ABOVE)), **properties)
        made.visible_camera = where is not None
        if made.data.node_tree is None or not made.data.use_nodes:
            made.data.use_nodes = True
        tree = made.data.node_tree
        tree.nodes.clear()
        net = Net(tree)
        color, strength = feed(net)
        net.tree.links.new(net.emission(color, strength), net.node("OutputLight").inputs[0])

    return make


WHITE = (1.0, 1.0, 1.0)
SMALL = {"shadow_soft_size": 0.1}


def feed(color=WHITE, strength=1.0):
    """A function of a net that gives color and strength, which may be functions of it too."""
    return lambda net: tuple(part(net) if callable(part) else part for part in (color, strength))


def _falloff(output, strength=1.0, **inputs):
    return feed(WHITE, socket("LightFalloff", output, {"Strength": strength} | inputs))


NODES = {
    "constant": ("POINT", feed((0.4, 0.8, 1.0), 1.5), SMALL),
    "blackbody": ("AREA", feed(socket("Blackbody", 0, {0: 3200.0})), {"size": 0.8}),
    "quadratic falloff": ("POINT", _falloff("Quadratic"), SMALL),
    "smooth quadratic falloff": ("POINT", _falloff("Quadratic", Smooth=1.0), SMALL),
    "linear falloff": ("POINT", _falloff("Linear", 0.4), SMALL),
    "constant falloff": ("AREA", _falloff("Constant", 0.2), {"size": 0.8}),
}
for _name, (_kind, _given, _properties) in NODES.items():
    lights("Light nodes", _name, light_with_nodes(_kind, _given, **_properties))


def _by(coordinates):
    """A color by a coordinate, from 0 to 1 where that goes from -1 to 1."""
    return feed(lambda net: net.scaled(net.out("TexCoord", coordinates), 0.5, 0.5))


_NORMAL, _OPAQUE = socket("TexCoord", "Normal"), texture(kind="opaque")
_AROUND = {0: socket("NewGeometry", "Incoming"), 1: (0.5, -0.2, -0.9)}
_TOWARD = socket("VectorMath", "Value", _AROUND, operation="DOT_PRODUCT")
_squares = feed(socket("TexChecker", "Color", {0: _NORMAL, "Scale": 3.3}))
_gradient = feed(WHITE, socket("TexGradient", "Fac", {0: _NORMAL}))
_incoming = feed(WHITE, socket("Math", 0, {0: _TOWARD, 1: 6.0}, operation="POWER"))
_image = feed(_OPAQUE)

NARROW = {"spot_size": 1.0, "spot_blend": 0.3}
DISK, SPHERE = {"shadow_soft_size": 0.3}, {"shadow_soft_size": 0.3, "use_soft_falloff": False}
BY_DIRECTION = {
    "spot, gradient by normal": ("SPOT", _gradient, {"shadow_soft_size": 0.0, "spot_size": 2.0}),
    "spot, color by normal": ("SPOT", _by("Normal"), {"shadow_soft_size": 0.1, **NARROW}),
    "spot, image": ("SPOT", _image, {"shadow_soft_size": 0.0, **NARROW}),
    "spot, image, wide": ("SPOT", _image, {"shadow_soft_size": 0.0, "spot_size": 2.7}),
    "spot, sphere, color by normal": ("SPOT", _by("Normal"), SPHERE | NARROW),
    "point, color by normal": ("POINT", _by("Normal"), DISK),
    "point, checker by normal": ("POINT", _squares, {"shadow_soft_size": 0.0}),
    "point, sphere, color by normal": ("POINT", _by("Normal"), SPHERE),
    "point, image": ("POINT", _image, {"shadow_soft_size": 0.2}),
    "point, incoming": ("POINT", _incoming, {"shadow_soft_size": 0.1}),
    "area, image": ("AREA", _image, {"size": 1.6}),
    "area, ellipse, color by generated": ("AREA", _by("Generated"), {"shape": "ELLIPSE", "size": 1.6, "size_y": 0.7}),
    "area, incoming": ("AREA", _incoming, {"size": 0.6}),
    "sun, image": ("SUN", _image, {"angle": 0.8}),
}  # fmt: skip
for _name, (_kind, _given, _properties) in BY_DIRECTION.items():
    lights("Light nodes", _name, light_with_nodes(_kind, _given, **_properties), effort=2)
_photons = {"settings": {"direct_light": DirectLight.PHOTONS, "photons": 16384}, "effort": 4}
for _name in ("spot, image", "spot, sphere, color by normal", "point, color by normal", "area, incoming"):
    _kind, _given, _properties = BY_DIRECTION[_name]
    lights("Light nodes", f"{_name}, by photons", light_with_nodes(_kind, _given, **_properties), **_photons)
for _name, _where in {
    "area, image": IN_VIEW,
    "sun, image": {"turn": (-95.0, 10.0, 10.0)},
    "point, sphere, color by normal": IN_VIEW,
    "point, image": IN_VIEW,
}.items():
    _kind, _given, _properties = BY_DIRECTION[_name]
    _size = {"AREA": {"size": 0.8}, "SUN": {}}.get(_kind, {"shadow_soft_size": 0.4})
    _make = light_with_nodes(_kind, _given, _where, **(_properties | _size))
    lights("Light nodes", f"{_name}, in view", _make, effort=3)


def _two() -> None:
    _light("POINT", 30.0, shadow_soft_size=0.1, color=(1.0, 0.5, 0.2))()
    _light("AREA", 40.0, {"at": (-1.5, -1.0, 2.0), "turn": (30.0, -40.0, 0.0)}, size=0.6, color=(0.3, 0.6, 1.0))()


lights("Lights", "two of them", _two)


def _glowing(feed, half=0.7):
    """A glowing square over the scene, fed by ``feed(net)``: color and strength."""

    def make() -> None:
        surface, net = material("Glow")
        net.output(net.emission(*feed(net)))
        stage.ground(surface, half, {"at": (0.6, -0.5, 2.6), "turn": (170.0, 15.0, 0.0)})

    return make


_CHECKER, _BACK = socket("TexChecker", "Fac", {"Scale": 2.0}), socket("NewGeometry", "Backfacing")
_squares_glow = socket("Math", 0, {0: _CHECKER, 1: 20.0}, operation="MULTIPLY")
_front_glows = socket("Math", 0, {0: _BACK, 1: -12.0, 2: 12.0}, operation="MULTIPLY_ADD")
_RAMP = socket("ValToRGB", 0, {0: socket("TexNoise", "Fac", {"Scale": 5.0})})
GLOWS = {
    "plain": feed((1.0, 0.8, 0.6), 10.0),
    "strength by an image": feed(_OPAQUE, 20.0),
    "strength by a checker": feed((1.0, 0.9, 0.8), _squares_glow),
    "one side only": feed((1.0, 0.9, 0.8), _front_glows),
    "by a ramp of noise": feed(_RAMP, 20.0),
}
for _name, _given in GLOWS.items():
    lights("Glowing mesh", _name, _glowing(_given), effort=2)


def _small_bulbs() -> None:
    surface, net = material("Bulb")
    net.output(net.emission((1.0, 0.8, 0.6), 60.0))
    for x, y in ((1.5, -1.2), (-1.4, -1.0)):
        stage.ball(surface, {"at": (x, y, 2.9), "scale": (0.18, 0.18, 0.18)}, 12)


lights("Glowing mesh", "two bulbs", _small_bulbs, effort=2)


def _copies() -> None:
    """Sixty of one ball, scaled unevenly, and every other one mirrored."""
    surface, net = material("Bulb")
    strength = net.out("Math", 0, {0: net.out("TexChecker", "Fac", {"Scale": 4.0, "Vector": net.out("TexCoord", "UV")}),
                                   1: 40.0, 2: 20.0}, operation="MULTIPLY_ADD")  # fmt: skip
    net.output(net.emission((1.0, 0.8, 0.6), strength))
    first = stage.ball(surface, {"at": (0.0, -0.5, 3.0), "scale": (0.05, 0.05, 0.05)}, 12)
    generator = np.random.default_rng(4)
    for number in range(59):
        x, y, z = generator.uniform((-1.8, -2.2, 2.7), (1.8, 0.4, 3.3))
        sides = generator.uniform(0.02, 0.12, 3) * ((-1.0) ** number, 1.0, 1.0)
        where = {"at": (x, y, z), "turn": tuple(generator.uniform(0.0, 360.0, 3)), "scale": tuple(sides)}
        link_object(first.data, place(**where), f"Bulb {number}")


lights("Glowing mesh", "sixty copies of one", _copies, effort=10, settings={"instancing": Instancing.TWO_LEVELS})


def _in_view(visible: bool):
    def make() -> None:
        _light("AREA", 60.0, IN_VIEW, size=0.8)().visible_camera = visible

    return make


lights("Area Light", "in view", _in_view(True), effort=3)
lights("Area Light", "hidden from the camera", _in_view(False), effort=3)
