# SPDX-License-Identifier: GPL-3.0-or-later
"""Worlds: colors, environment pictures, skies, and nodes by direction and ray."""

import bpy

from ...net import Net, material
from .. import stage
from ..rows import Kind, Row, add
from ..values.image_textures import picture
from .light_limits import brighten


def _net() -> Net:
    return Net(bpy.context.scene.world.node_tree)


def world(group: str, name: str, feed, surface=None, kind: Kind = Kind.LIGHT, **members: object) -> None:
    """A row of a world whose Background is fed by ``feed(net)``: color and strength."""

    def build() -> None:
        stage.empty()
        plain, net = material("Plain")
        net.output((surface or _plain)(net))
        stage.set_up(plain)
        if surface is _shiny:
            bpy.data.objects.remove(bpy.data.objects["Ground"])  # Cycles ends long paths at random
        net = _net()
        color, strength = feed(net)
        background = stage.background()
        net.set(background.inputs["Color"], color)
        net.set(background.inputs["Strength"], strength)

    add(Row(group, name, build, kind, **members))


def _plain(net):
    return net.out("BsdfDiffuse", inputs={"Color": (0.6, 0.55, 0.5)})


def _shiny(net):
    return net.out("BsdfAnisotropic", inputs={"Color": 0.9, "Roughness": 0.0}, distribution="GGX")


def _black(net):
    return net.out("BsdfDiffuse", inputs={"Color": 0.0})


MAPPED = {"mean": 0.02, "block": 0.05, "reason": "worlds with nodes are looked up in a map 1024 directions wide"}
MIRRORED = {"kind": Kind.VALUES, "settings": {"camera_path_length": 4}}
"""Options of rows in which only mirrors are seen."""


def _environment(mapping=None, projection="EQUIRECTANGULAR", interpolation="Linear"):
    def give(net):
        image = bpy.data.images.load(picture("exr", 32, 16))
        inputs = {}
        if mapping is not None:
            inputs["Vector"] = net.out("Mapping", inputs={0: net.out("TexCoord", "Generated"), "Rotation": mapping})
        return net.out(
            "TexEnvironment", 0, inputs, image=image, projection=projection, interpolation=interpolation
        ), 0.5

    return give


world("Background", "color", lambda net: ((0.4, 0.6, 1.0), 1.2))
world("Environment Texture", "as it comes", _environment())
world("Environment Texture", "turned, mirrored", _environment((0.4, -0.5, 1.1)), _shiny, **MIRRORED, **MAPPED)
world("Environment Texture", "turned", _environment((0.0, 0.0, 1.1)))
world("Environment Texture", "turned about all axes", _environment((0.4, -0.5, 1.1)))
for _interpolation in ("Closest", "Cubic"):
    world(
        "Environment Texture",
        f"mirrored, {_interpolation}",
        _environment(interpolation=_interpolation),
        _shiny,
        **MIRRORED,
        **MAPPED,
    )
world(
    "Environment Texture", "mirror ball, mirrored", _environment(projection="MIRROR_BALL"), _shiny, **MIRRORED, **MAPPED
)
world(
    "Environment Texture",
    "a bright spot",
    lambda net: (
        net.out(
            "MixRGB",
            0,
            {
                0: net.out(
                    "Math",
                    0,
                    {
                        0: net.out(
                            "VectorMath",
                            "Value",
                            {0: net.out("TexCoord", "Generated"), 1: (0.5, -0.5, 0.7)},
                            operation="DOT_PRODUCT",
                        ),
                        1: 0.9,
                    },
                    operation="GREATER_THAN",
                ),
                1: (0.1, 0.1, 0.15),
                2: (9.0, 8.0, 6.0),
            },
        ),
        1.0,
    ),
)
for _output in ("Generated", "Normal", "Object", "Reflection"):
    world(
        "World coordinates",
        _output,
        (lambda output: lambda net: (net.scaled(net.out("TexCoord", output), 0.4, 0.5), 1.0))(_output),
        _shiny,
        **MIRRORED,
    )
world("World coordinates", "Window", lambda net: (net.out("TexCoord", "Window"), 1.0), _black, **MIRRORED)
world(
    "World nodes",
    "gradient",
    lambda net: (net.out("ValToRGB", 0, {0: net.out("SeparateXYZ", 2, {0: net.out("TexCoord", "Generated")})}), 1.0),
)
world("World nodes", "noise", lambda net: (net.out("TexNoise", "Color", {"Scale": 3.0}), 1.0))
world(
    "World nodes",
    "black to the camera",
    lambda net: (
        (0.6, 0.8, 1.0),
        net.out("Math", 0, {0: 1.0, 1: net.out("LightPath", "Is Camera Ray")}, operation="SUBTRACT"),
    ),
)
world("World nodes", "blackbody", lambda net: (net.out("Blackbody", 0, {0: 4500.0}), 0.7))


def _mixed_world(net):
    """Two Backgrounds by Is Camera Ray."""
    tree = net.tree
    first = stage.background()
    second = net.node("Background", {"Color": (0.1, 0.3, 0.1), "Strength": 1.0})
    mix = net.node("MixShader", {0: net.out("LightPath", "Is Camera Ray"), 1: first.outputs[0], 2: second.outputs[0]})
    output = next(node for node in tree.nodes if node.type == "OUTPUT_WORLD")
    tree.links.new(mix.outputs[0], output.inputs["Surface"])
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


def _spot(bounces):
    """A world of one bright spot, of which Cycles' rays that happen to meet it, and ask for no bounces, know little."""

    def feed(net):
        bpy.context.scene.world.cycles.max_bounces = bounces
        brighten()
        along = net.out("VectorMath", "Value", {0: net.out("TexCoord", "Generated"), 1: (0.5, -0.5, 0.707)},
                        operation="DOT_PRODUCT")  # fmt: skip
        spot = net.out("Math", 0, {0: along, 1: 0.97}, operation="GREATER_THAN")
        return (1.0, 0.9, 0.8), net.out("Math", 0, {0: spot, 1: 30.0}, operation="MULTIPLY")

    return feed


SAMPLED = {"reason": "Cycles leaves in what its rays find of the world by chance", "mean": 0.03, "block": 0.05}


def _even(bounces):
    def feed(net):
        bpy.context.scene.world.cycles.max_bounces = bounces
        brighten()
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


def _limpid(net):
    return net.out("BsdfGlass", inputs={"Color": 0.9, "Roughness": 0.0, "IOR": 1.3})


def _principled(net):
    return net.out("BsdfPrincipled", inputs={"Base Color": (0.6, 0.4, 0.3, 1.0), "Roughness": 0.3})


VISIBILITY = "Ray Visibility of the world"
world(VISIBILITY, "hidden from the camera", _hidden("camera"), _principled, effort=2)
for _kind, _name in (("diffuse", "diffuse surfaces"), ("glossy", "reflections")):
    world(VISIBILITY, f"hidden from {_name}", _hidden(_kind, shiny=True), effort=2)
    world(VISIBILITY, f"with colors, hidden from {_name}", _hidden(_kind, even=False, shiny=True), effort=2)
world(VISIBILITY, "hidden from transmission", _hidden("transmission"), _limpid, effort=2)
MIXED = "Cycles takes a ray for that of the part which chose it, and lets all parts of a material count"
world(VISIBILITY, "hidden from diffuse parts", _hidden("diffuse"), _principled, effort=2, reason=MIXED, mean=0.03)
