# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes of numbers, vectors and colors and procedural textures, as they are used; groups, muted nodes, reroutes."""

import bpy

from ...net import socket
from ..rows import value


def _noise(output="Fac"):
    return socket("TexNoise", output, {"Scale": 2.0, "Detail": 1.0})


NUMBER, COLOR = _noise(), _noise("Color")
GENERATED, OBJECT = socket("TexCoord", "Generated"), socket("TexCoord", "Object")


def _of_noise(kind, name=0, output=0, inputs=None, color=False, prepare=None, **properties):
    """A node fed by noise."""

    def give(net):
        node = net.node(kind, inputs, **properties)
        net.set(node.inputs[name], (COLOR if color else NUMBER)(net))
        if prepare is not None:
            prepare(node)
        return node.outputs[output]

    return give


BRICK = {"Scale": 3.0, "Mortar Size": 0.06, "Mortar Smooth": 1.0}
TEXTURES = {
    "Noise": ("TexNoise", {"Scale": 3.0}, {}), "Noise, 4D": ("TexNoise", {"W": 0.7}, {"noise_dimensions": "4D"}),
    "Noise, ridged": ("TexNoise", {"Scale": 2.0}, {"noise_type": "RIDGED_MULTIFRACTAL"}),
    "Voronoi": ("TexVoronoi", {"Scale": 3.0}, {}), "Voronoi, F2": ("TexVoronoi", {}, {"feature": "F2"}),
    "Voronoi, edges": ("TexVoronoi", {"Scale": 3.0}, {"feature": "DISTANCE_TO_EDGE"}),
    "Checker": ("TexChecker", {"Scale": 4.3}, {}), "Brick": ("TexBrick", BRICK, {}),
    "Brick, offset": ("TexBrick", BRICK, {"offset": 0.3, "squash": 1.5, "squash_frequency": 3}),
    "Wave": ("TexWave", {"Scale": 2.0, "Distortion": 2.0}, {}),
    "Wave, rings": ("TexWave", {"Scale": 2.0}, {"wave_type": "RINGS", "wave_profile": "SAW"}),
    "Gradient": ("TexGradient", {}, {}), "Gradient, spherical": ("TexGradient", {}, {"gradient_type": "SPHERICAL"}),
    "Magic": ("TexMagic", {"Scale": 2.0}, {"turbulence_depth": 3}), "White Noise": ("TexWhiteNoise", {}, {}),
    "Gabor": ("TexGabor", {"Scale": 3.0}, {"gabor_type": "3D"}),
}  # fmt: skip
for _name, (_kind, _inputs, _properties) in TEXTURES.items():
    value("Textures", _name, socket(_kind, 0, _inputs, **_properties), 0.9, 0.1)
for _output, _inputs, _normalized in (
    ("Segment Coordinates", {"Sides": 5.0, "Roundness": 0.4}, False),
    ("Segment Coordinates", {"Sides": 6.4, "Roundness": 0.6}, True),
    ("Segment ID", {"Sides": 4.5}, False),
):
    _name = f"{_output}, {_inputs['Sides']:g} sides" + (", normalized" if _normalized else "")
    _give = socket("RadialTiling", _output, _inputs | {"Vector": OBJECT}, normalize=_normalized)
    value("Radial Tiling", _name, _give, 0.2, 0.6)
value("Textures", "Voronoi, Color", socket("TexVoronoi", "Color", {"Scale": 3.0}))
_CELLS = socket("VectorMath", inputs={0: GENERATED, 1: (0.211,) * 3}, operation="SNAP")
value("Textures", "White Noise, of cells", socket("TexWhiteNoise", "Color", {"Vector": _CELLS}))
value("Textures", "Gradient of an object's coordinates", socket("TexGradient", inputs={"Vector": OBJECT}), 0.8, 0.1)

_TURNED = {0: OBJECT, "Rotation": (0.4, 0.2, -0.7), "Scale": (0.5, 0.8, 1.5)}
for _type in ("POINT", "TEXTURE", "VECTOR", "NORMAL"):
    _inputs = _TURNED | ({"Location": (0.1, 0.2, 0.3)} if _type in {"POINT", "TEXTURE"} else {})
    value("Mapping", _type, socket("Mapping", inputs=_inputs, vector_type=_type), 0.1, 0.5)


def _mapped_texture(kind, **mapping):
    """A texture whose node maps its coordinates itself."""

    def give(net):
        node = net.node(kind, {"Vector": OBJECT, "Scale": 2.0, "Detail": 1.0})
        for name, chosen in mapping.items():
            setattr(node.texture_mapping, name, chosen)
        return node.outputs["Color"]

    return give


_PLACED = {"translation": (0.3, -0.2, 0.1), "rotation": (0.4, 0.2, -0.7), "scale": (0.5, 0.8, 1.5)}
for _type in ("POINT", "TEXTURE", "VECTOR", "NORMAL"):
    value("Texture Mapping", _type, _mapped_texture("TexNoise", vector_type=_type, **_PLACED))
_EXCHANGED = {"mapping_x": "Z", "mapping_y": "X", "mapping_z": "NONE"}
value("Texture Mapping", "axes exchanged", _mapped_texture("TexNoise", **_EXCHANGED, **_PLACED))

for _operation in ("MULTIPLY", "POWER", "SINE", "LESS_THAN", "SMOOTH_MIN", "PINGPONG"):
    value("Math", _operation, _of_noise("Math", 0, 0, {1: 0.45, 2: 0.3}, operation=_operation), 0.8, 0.1)
value("Math", "clamped", _of_noise("Math", 0, 0, {1: 0.6}, operation="ADD", use_clamp=True))
for _operation in ("ADD", "CROSS_PRODUCT", "DOT_PRODUCT", "NORMALIZE", "REFLECT", "WRAP"):
    _output = 1 if _operation == "DOT_PRODUCT" else 0
    _give = _of_noise("VectorMath", 0, _output, {1: (0.5, 0.2, 0.8)}, True, operation=_operation)
    value("Vector Math", _operation, _give, 0.3, 0.4)

BLENDS = (
    "MIX", "MULTIPLY", "OVERLAY", "SCREEN", "DIFFERENCE", "COLOR", "HUE", "SATURATION", "VALUE", "LINEAR_LIGHT",
)  # fmt: skip
for _blend in BLENDS:
    _inputs = {"Factor_Float": 0.7, "A_Color": COLOR, "B_Color": (0.7, 0.3, 0.1)}
    value("Mix", f"Color, {_blend}", socket("Mix", 2, _inputs, data_type="RGBA", blend_type=_blend), 0.7, 0.8)
value("Mix", "Float", socket("Mix", 0, {0: NUMBER, 2: 0.2, 3: 0.9}))
_inputs, _properties = {1: COLOR, 4: (0.2, 0.3, 0.1), 5: (0.9, 0.4, 0.6)}, {"factor_mode": "NON_UNIFORM"}
value("Mix", "Vector, by components", socket("Mix", 1, _inputs, data_type="VECTOR", **_properties))
_inputs = {0: NUMBER, 1: (0.2, 0.3, 0.1), 2: (0.9, 0.4, 0.6)}
value("Mix", "legacy, ADD", socket("MixRGB", 0, _inputs, blend_type="ADD", use_clamp=True))


def _ramp(interpolation, mode="RGB"):
    def prepare(node):
        ramp = node.color_ramp
        ramp.color_mode, ramp.interpolation = mode, interpolation
        ramp.elements[0].position, ramp.elements[0].color = 0.3, (0.1, 0.2, 0.8, 1.0)
        ramp.elements[1].position, ramp.elements[1].color = 0.65, (1.0, 0.6, 0.1, 0.5)
        ramp.elements.new(0.5).color = (0.2, 0.9, 0.3, 1.0)

    return prepare


for _interpolation in ("LINEAR", "CONSTANT", "EASE", "B_SPLINE", "CARDINAL"):
    value("Color Ramp", _interpolation, _of_noise("ValToRGB", prepare=_ramp(_interpolation)))
value("Color Ramp", "Alpha", _of_noise("ValToRGB", 0, 1, prepare=_ramp("LINEAR")))
value("Color Ramp", "HSV", _of_noise("ValToRGB", prepare=_ramp("LINEAR", "HSV")))


def _bend(node):
    for number, curve in enumerate(node.mapping.curves):
        curve.points.new(0.4, 0.2 + 0.2 * number)
    node.mapping.update()


value("RGB Curves", "bent", _of_noise("RGBCurve", 1, color=True, prepare=_bend))
value("Vector Curves", "bent", _of_noise("VectorCurve", 1, color=True, prepare=_bend), 0.5, 0.5)
value("Float Curve", "bent", _of_noise("FloatCurve", 1, prepare=_bend))


def _swapped(mode):
    """A color taken apart and put together the other way round."""

    def give(net):
        if mode is None:
            parts = net.node("SeparateXYZ", {0: COLOR}).outputs
            return net.out("CombineXYZ", inputs={0: parts[2], 1: parts[0], 2: parts[1]})
        parts = net.node("SeparateColor", {0: COLOR}, mode=mode).outputs
        return net.out("CombineColor", inputs={0: parts[0], 1: parts[2], 2: parts[1]}, mode=mode)

    return give


COLORS = {
    "Hue/Saturation": ("HueSaturation", "Color", {"Hue": 0.7, "Saturation": 1.4, "Value": 0.8, "Fac": 0.9}),
    "Brightness/Contrast": ("BrightContrast", "Color", {"Bright": 0.1, "Contrast": 0.4}),
    "Gamma": ("Gamma", "Color", {"Gamma": 1.8}), "Invert": ("Invert", "Color", {"Fac": 0.8}),
    "RGB to BW": ("RGBToBW", "Color", {}),
}  # fmt: skip
for _name, (_kind, _socket, _inputs) in COLORS.items():
    value("Colors", _name, _of_noise(_kind, _socket, 0, _inputs, True))
for _mode in ("RGB", "HSV", "HSL"):
    value("Colors", f"Separate and Combine Color, {_mode}", _swapped(_mode))
value("Colors", "Separate and Combine XYZ", _swapped(None))
value("Colors", "RGB", socket("RGB"))
for _name, _given in (("color", COLOR), ("vector", GENERATED)):
    value("Colors", f"{_name} as a number", socket("Math", inputs={0: _given, 1: 1.0}, operation="MULTIPLY"))

for _type in ("LINEAR", "STEPPED", "SMOOTHSTEP", "SMOOTHERSTEP"):
    value("Map Range", _type, _of_noise("MapRange", 0, 0, {1: 0.35, 2: 0.6, 3: 0.1, 4: 0.9}, interpolation_type=_type))
value("Map Range", "not clamped", _of_noise("MapRange", 0, 0, {1: 0.2, 2: 0.8, 3: 0.1, 4: 0.9}, clamp=False), 1.0, 0.2)
_inputs = {"Vector": COLOR, "From_Min_FLOAT3": (0.3, 0.2, 0.1)}
value("Map Range", "Vector", socket("MapRange", "Vector", _inputs, data_type="FLOAT_VECTOR"), 0.5, 0.5)
value("Clamp", "range", _of_noise("Clamp", 0, 0, {1: 0.6, 2: 0.4}, clamp_type="RANGE"))


def _from_to(low, high):
    return socket("MapRange", inputs={0: NUMBER, 1: 0.3, 2: 0.7, 3: low, 4: high})


value("Blackbody", "800 to 9000 K", socket("Blackbody", inputs={0: _from_to(800.0, 9000.0)}), 0.1, 0.1)
value("Wavelength", "380 to 720 nm", socket("Wavelength", inputs={0: _from_to(380.0, 720.0)}), 0.5, 0.5)
value("Normal", "dot", socket("Normal", "Dot", {0: socket("TexCoord", "Normal")}), 0.4, 0.5)
value("Vector Rotate", "axis and angle", _of_noise("VectorRotate", 0, 0, {"Angle": 0.8}, True), 0.4, 0.4)

# --- groups, muted nodes, reroutes --------------------------------------------------------------------


def _group(name: str, depth: int) -> bpy.types.NodeTree:
    """A group that multiplies its color by its value, in groups inside groups."""
    tree = bpy.data.node_groups.new(name, "ShaderNodeTree")
    tree.interface.new_socket("Shade", in_out="INPUT", socket_type="NodeSocketColor")
    factor = tree.interface.new_socket("Amount", in_out="INPUT", socket_type="NodeSocketFloat")
    factor.default_value = 0.7
    tree.interface.new_socket("Result", in_out="OUTPUT", socket_type="NodeSocketColor")
    into, out = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    if depth:
        inner = tree.nodes.new("ShaderNodeGroup")
        inner.node_tree = _group(f"{name} inside", depth - 1)
        tree.links.new(into.outputs[1], inner.inputs[1])
    else:
        inner = tree.nodes.new("ShaderNodeVectorMath")
        inner.operation = "SCALE"
        tree.links.new(into.outputs[1], inner.inputs["Scale"])
    tree.links.new(into.outputs[0], inner.inputs[0])
    tree.links.new(inner.outputs[0], out.inputs[0])
    return tree


def _grouped(depth, amount=None, shade=True):
    def give(net):
        node = net.tree.nodes.new("ShaderNodeGroup")
        node.node_tree = _group("Group", depth)
        net.set(node.inputs[0], COLOR(net) if shade else (0.3, 0.6, 0.2))
        if amount is not None:
            net.set(node.inputs[1], amount)
        return node.outputs[0]

    return give


value("Groups", "one", _grouped(0))
value("Groups", "nested three times", _grouped(2, 0.4))
value("Groups", "unlinked input", _grouped(1, 0.9, False))


def _twice(net):
    first = _grouped(1, 0.5)(net)
    node = net.tree.nodes.new("ShaderNodeGroup")
    node.node_tree = bpy.data.node_groups["Group"]
    net.set(node.inputs[0], first)
    return node.outputs[0]


value("Groups", "used twice", _twice)


def _muted_group(net):
    out = _grouped(0, 0.5)(net)
    out.node.mute = True
    return out


value("Muted", "group", _muted_group)


def _muted(kind, socket=0, output=0, **properties):
    def give(net):
        out = _of_noise(kind, socket, output, None, True, **properties)(net)
        out.node.mute = True
        return out

    return give


value("Muted", "Gamma", _muted("Gamma"))
value("Muted", "Math", _muted("Math", operation="SINE"))
value("Muted", "Color Ramp", _muted("ValToRGB"))


def _muted_source(kind):
    def give(net):
        node = net.node(kind)
        node.mute = True
        return node.outputs[0]

    return give


value("Muted", "Noise Texture", _muted_source("TexNoise"), 1.0, 0.2)
_inputs = {"Factor_Float": 0.5, "A_Color": _muted_source("RGB"), "B_Color": (0.7, 0.3, 0.1)}
value("Muted", "RGB", socket("Mix", 2, _inputs, data_type="RGBA"), 1.0, 0.1)


def _reroute(net):
    color = COLOR(net)
    for _ in range(3):
        knot = net.tree.nodes.new("NodeReroute")
        net.tree.links.new(color, knot.inputs[0])
        color = knot.outputs[0]
    return color


value("Reroute", "three in a row", _reroute)


def _muted_link(net):
    node = net.node("Gamma", {"Color": (0.3, 0.5, 0.7), "Gamma": 1.3})
    net.tree.links.new(COLOR(net), node.inputs[0]).is_muted = True
    return node.outputs[0]


value("Muted", "link", _muted_link)
