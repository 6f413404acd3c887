# SPDX-License-Identifier: GPL-3.0-or-later
"""Worlds: colors, environment pictures, skies, and nodes by direction and ray."""

from collections.abc import Callable

import bpy
import numpy as np

from ...net import Net, material, socket
from ...scenes import GLOSSY, background, camera, place, plane
from ...scenes import material as scenes_material
from .. import stage
from ..rows import Kind, Row, add
from ..values.image_textures import picture
from .light_limits import brighten
from .lights import feed


def world(group: str, name: str, given, surface=None, kind: Kind = Kind.LIGHT, **members: object) -> None:
    """A row of a world whose Background is fed by ``given(net)``: color and strength."""

    def build() -> None:
        stage.empty()
        plain, net = material("Plain")
        net.output((surface or _plain)(net))
        stage.set_up(plain)
        if surface is _shiny:
            bpy.data.objects.remove(bpy.data.objects["Ground"])  # Cycles ends long paths at random
        net = Net(bpy.context.scene.world.node_tree)
        for name, value in zip(("Color", "Strength"), given(net), strict=True):
            net.set(background().inputs[name], value)

    add(Row(group, name, build, kind, **members))


_plain = socket("BsdfDiffuse", inputs={"Color": (0.6, 0.55, 0.5)})


_shiny = socket("BsdfAnisotropic", inputs={"Color": 0.9, "Roughness": 0.0}, distribution="GGX")


_black = socket("BsdfDiffuse", inputs={"Color": 0.0})


MAPPED = {"mean": 0.02, "block": 0.05, "reason": "worlds with nodes are looked up in a map 1024 directions wide"}
MIRRORED = {"kind": Kind.VALUES, "settings": {"camera_path_length": 4}}
"""Options of rows in which only mirrors are seen."""


def _environment(turn=None, **properties):
    turned = {"Vector": socket("Mapping", inputs={0: GENERATED, "Rotation": turn})} if turn else {}

    def give(net):
        image = bpy.data.images.load(picture("exr", 32, 16))
        return net.out("TexEnvironment", 0, turned, image=image, **properties), 0.5

    return give


GENERATED, CAMERA_RAY = socket("TexCoord", "Generated"), socket("LightPath", "Is Camera Ray")


def _around(direction, cosine):
    """1 within an angle around a direction, else 0."""
    along = socket("VectorMath", "Value", {0: GENERATED, 1: direction}, operation="DOT_PRODUCT")
    return socket("Math", 0, {0: along, 1: cosine}, operation="GREATER_THAN")


GROUP = "Environment Texture"
_spotted = socket("MixRGB", 0, {0: _around((0.5, -0.5, 0.7), 0.9), 1: (0.1, 0.1, 0.15), 2: (9.0, 8.0, 6.0)})
world("Background", "color", feed((0.4, 0.6, 1.0), 1.2))
world(GROUP, "as it comes", _environment())
world(GROUP, "turned, mirrored", _environment((0.4, -0.5, 1.1)), _shiny, **MIRRORED, **MAPPED)
world(GROUP, "turned", _environment((0.0, 0.0, 1.1)))
world(GROUP, "turned about all axes", _environment((0.4, -0.5, 1.1)))
for _interpolation in ("Closest", "Cubic"):
    _given = _environment(interpolation=_interpolation)
    world(GROUP, f"mirrored, {_interpolation}", _given, _shiny, **MIRRORED, **MAPPED)
world(GROUP, "mirror ball, mirrored", _environment(projection="MIRROR_BALL"), _shiny, **MIRRORED, **MAPPED)
world(GROUP, "a bright spot", feed(_spotted))


def _far_away(in_mirror: bool) -> Callable[[], None]:
    """Some pixels of an image 8192 pixels wide, each another gray, fill the picture, straight or in a mirror."""

    def build() -> None:
        stage.empty()
        pixels = np.ones((16, 8192, 4), np.float32)
        pixels[..., :3] = np.random.default_rng(5).random((16, 8192, 1))
        image = bpy.data.images.new("Wide", 8192, 16, float_buffer=True)
        image.pixels.foreach_set(pixels.ravel())
        image.pack()
        net = Net(bpy.context.scene.world.node_tree)
        net.set(background().inputs["Color"], net.out("TexEnvironment", 0, image=image))
        background().inputs["Strength"].default_value = 1.0
        if in_mirror:
            plane(
                1.0,
                scenes_material(GLOSSY, Color=(0.9, 0.9, 0.9), Roughness=0.0),
                place((2.0, 0.0, 0.0), (0.0, 90.0, 20.0)),
            )
        camera((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), 0.7)

    return build


add(Row(GROUP, "8192 pixels wide", _far_away(False), Kind.VALUES))
_TURNS = {"reason": "a mirror's normal has 16 bits, which turn what is seen by a twentieth of a pixel", "mean": 0.03}
add(
    Row(GROUP, "8192 pixels wide, mirrored", _far_away(True), Kind.VALUES, settings={"camera_path_length": 4}, **_TURNS)
)


def _shades(output):
    return feed(lambda net: net.scaled(net.out("TexCoord", output), 0.4, 0.5))


GROUP = "World coordinates"
for _output in ("Generated", "Normal", "Object", "Reflection"):
    world(GROUP, _output, _shades(_output), _shiny, **MIRRORED)
world(GROUP, "Window", feed(socket("TexCoord", "Window")), _black, **MIRRORED)

GROUP = "World nodes"
_height = socket("SeparateXYZ", 2, {0: GENERATED})
_unseen = socket("Math", 0, {0: 1.0, 1: CAMERA_RAY}, operation="SUBTRACT")
world(GROUP, "gradient", feed(socket("ValToRGB", 0, {0: _height})))
world(GROUP, "noise", feed(socket("TexNoise", "Color", {"Scale": 3.0})))
world(GROUP, "black to the camera", feed((0.6, 0.8, 1.0), _unseen))
world(GROUP, "blackbody", feed(socket("Blackbody", 0, {0: 4500.0}), 0.7))


def _mixed_world(net):
    """Two Backgrounds by Is Camera Ray."""
    first = background()
    second = net.node("Background", {"Color": (0.1, 0.3, 0.1), "Strength": 1.0})
    mix = net.node("MixShader", {0: CAMERA_RAY, 1: first.outputs[0], 2: second.outputs[0]})
    net.set(net.find("OUTPUT_WORLD").inputs["Surface"], mix.outputs[0])
    return (0.8, 0.7, 0.6), 1.0


world("World nodes", "mixed by Is Camera Ray", _mixed_world)

SKIES = {
    "SINGLE_SCATTERING": {"sun_disc": False}, "MULTIPLE_SCATTERING": {"sun_disc": False},
    "MULTIPLE_SCATTERING, sun": {"sun_disc": True, "sun_size": 0.2, "sun_intensity": 0.1},
    "PREETHAM": {}, "HOSEK_WILKIE": {},
}  # fmt: skip


def _sky(kind, properties):
    def feed(net):
        node = net.node("TexSky", sky_type=kind)
        if hasattr(node, "sun_elevation"):
            node.sun_elevation, node.sun_rotation = 0.6, 2.2
        for name, value in properties.items():
            setattr(node, name, value)
        return node.outputs[0], 0.1

    return feed


for _name, _properties in SKIES.items():
    world("Sky Texture", _name, _sky(_name.partition(",")[0], _properties))


def _horizon() -> None:
    """The camera looks at the horizon below a low sun, where radiance falls to a third within half a degree."""
    stage.empty()
    net = Net(bpy.context.scene.world.node_tree)
    sky = net.node("TexSky", sky_type="MULTIPLE_SCATTERING", sun_disc=False, sun_elevation=0.23, sun_rotation=0.0)
    net.set(background().inputs["Color"], sky.outputs[0])
    background().inputs["Strength"].default_value = 0.1
    camera((0.0, 0.0, 0.0), (0.0, 1.0, -0.02), 40.0)


add(Row("Sky Texture", "horizon", _horizon, Kind.VALUES, reason=MAPPED["reason"]))


def _limited(bounces, given):
    def limit(net):
        bpy.context.scene.world.cycles.max_bounces = bounces
        brighten()
        return given(net)

    return limit


SAMPLED = {"reason": "Cycles leaves in what its rays find of the world by chance", "mean": 0.03, "block": 0.05}
"""Members of the row of a bright spot, of which Cycles' rays that meet it by chance, and ask for no bounces, know
little."""
_brightness = socket("Math", 0, {0: _around((0.5, -0.5, 0.707), 0.97), 1: 30.0}, operation="MULTIPLY")
world("Max Bounces", "world with a bright spot, 0", _limited(0, feed((1.0, 0.9, 0.8), _brightness)), **SAMPLED)
world("Max Bounces", "even world, 0", _limited(0, feed((0.5, 0.55, 0.6))))


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


_limpid = socket("BsdfGlass", inputs={"Color": 0.9, "Roughness": 0.0, "IOR": 1.3})


_principled = socket("BsdfPrincipled", inputs={"Base Color": (0.6, 0.4, 0.3, 1.0), "Roughness": 0.3})


VISIBILITY = "Ray Visibility of the world"
world(VISIBILITY, "hidden from the camera", _hidden("camera"), _principled, effort=2)
for _kind, _name in (("diffuse", "diffuse surfaces"), ("glossy", "reflections")):
    world(VISIBILITY, f"hidden from {_name}", _hidden(_kind, shiny=True), effort=2)
    world(VISIBILITY, f"with colors, hidden from {_name}", _hidden(_kind, even=False, shiny=True), effort=2)
world(VISIBILITY, "hidden from transmission", _hidden("transmission"), _limpid, effort=2)
MIXED = "Cycles takes a ray for that of the part which chose it, and lets all parts of a material count"
world(VISIBILITY, "hidden from diffuse parts", _hidden("diffuse"), _principled, effort=2, reason=MIXED, mean=0.03)
