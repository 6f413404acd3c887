# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes of numbers, vectors and colors and procedural textures, as they are used; groups, muted nodes, reroutes."""

import bpy

from ..rows import value


def _noise(net, output="Fac", **inputs):
    return net.out("TexNoise", output, {"Scale": 2.0, "Detail": 1.0} | inputs)


def _of_noise(kind, socket=0, output=0, inputs=None, color=False, prepare=None, **properties):
    """A node fed by noise."""

    def give(net):
        node = net.node(kind, inputs, **properties)
        net.set(node.inputs[socket], _noise(net, "Color" if color else "Fac"))
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
    value(
        "Textures",
        _name,
        (lambda kind, inputs, properties: lambda net: net.out(kind, 0, inputs, **properties))(
            _kind, _inputs, _properties
        ),
        0.9,
        0.1,
    )
for _output, _inputs, _normalized in (
    ("Segment Coordinates", {"Sides": 5.0, "Roundness": 0.4}, False),
    ("Segment Coordinates", {"Sides": 6.4, "Roundness": 0.6}, True),
    ("Segment ID", {"Sides": 4.5}, False),
):
    value(
        "Radial Tiling",
        f"{_output}, {_inputs['Sides']:g} sides" + (", normalized" if _normalized else ""),
        (
            lambda output, inputs, normalized: (
                lambda net: net.out(
                    "RadialTiling", output, inputs | {"Vector": net.out("TexCoord", "Object")}, normalize=normalized
                )
            )
        )(_output, _inputs, _normalized),
        0.2,
        0.6,
    )
value("Textures", "Voronoi, Color", lambda net: net.out("TexVoronoi", "Color", {"Scale": 3.0}))
value(
    "Textures",
    "White Noise, of cells",
    lambda net: net.out(
        "TexWhiteNoise",
        "Color",
        {
            "Vector": net.out(
                "VectorMath", inputs={0: net.out("TexCoord", "Generated"), 1: (0.211,) * 3}, operation="SNAP"
            )
        },
    ),
)
value(
    "Textures",
    "Gradient of an object's coordinates",
    lambda net: net.out("TexGradient", inputs={"Vector": net.out("TexCoord", "Object")}),
    0.8,
    0.1,
)

for _type in ("POINT", "TEXTURE", "VECTOR", "NORMAL"):
    value(
        "Mapping",
        _type,
        (
            lambda kind: (
                lambda net: net.out(
                    "Mapping",
                    inputs={0: net.out("TexCoord", "Object"), "Rotation": (0.4, 0.2, -0.7), "Scale": (0.5, 0.8, 1.5)}
                    | ({"Location": (0.1, 0.2, 0.3)} if kind in {"POINT", "TEXTURE"} else {}),
                    vector_type=kind,
                )
            )
        )(_type),
        0.1,
        0.5,
    )

for _operation in ("MULTIPLY", "POWER", "SINE", "LESS_THAN", "SMOOTH_MIN", "PINGPONG"):
    value("Math", _operation, _of_noise("Math", 0, 0, {1: 0.45, 2: 0.3}, operation=_operation), 0.8, 0.1)
value("Math", "clamped", _of_noise("Math", 0, 0, {1: 0.6}, operation="ADD", use_clamp=True))
for _operation in ("ADD", "CROSS_PRODUCT", "DOT_PRODUCT", "NORMALIZE", "REFLECT", "WRAP"):
    _socket = 1 if _operation == "DOT_PRODUCT" else 0
    value(
        "Vector Math",
        _operation,
        _of_noise("VectorMath", 0, _socket, {1: (0.5, 0.2, 0.8)}, True, operation=_operation),
        0.3,
        0.4,
    )

for _blend in (
    "MIX",
    "MULTIPLY",
    "OVERLAY",
    "SCREEN",
    "DIFFERENCE",
    "COLOR",
    "HUE",
    "SATURATION",
    "VALUE",
    "LINEAR_LIGHT",
):
    value(
        "Mix",
        f"Color, {_blend}",
        (
            lambda blend: (
                lambda net: net.out(
                    "Mix",
                    2,
                    {"Factor_Float": 0.7, "A_Color": _noise(net, "Color"), "B_Color": (0.7, 0.3, 0.1)},
                    data_type="RGBA",
                    blend_type=blend,
                )
            )
        )(_blend),
        0.7,
        0.8,
    )
value("Mix", "Float", lambda net: net.out("Mix", 0, {0: _noise(net), 2: 0.2, 3: 0.9}))
value(
    "Mix",
    "Vector, by components",
    lambda net: net.out(
        "Mix",
        1,
        {1: _noise(net, "Color"), 4: (0.2, 0.3, 0.1), 5: (0.9, 0.4, 0.6)},
        data_type="VECTOR",
        factor_mode="NON_UNIFORM",
    ),
)
value(
    "Mix",
    "legacy, ADD",
    lambda net: net.out(
        "MixRGB", inputs={0: _noise(net), 1: (0.2, 0.3, 0.1), 2: (0.9, 0.4, 0.6)}, blend_type="ADD", use_clamp=True
    ),
)


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

COLORS = {
    "Hue/Saturation": ("HueSaturation", "Color", {"Hue": 0.7, "Saturation": 1.4, "Value": 0.8, "Fac": 0.9}),
    "Brightness/Contrast": ("BrightContrast", "Color", {"Bright": 0.1, "Contrast": 0.4}),
    "Gamma": ("Gamma", "Color", {"Gamma": 1.8}), "Invert": ("Invert", "Color", {"Fac": 0.8}),
    "RGB to BW": ("RGBToBW", "Color", {}),
}  # fmt: skip
for _name, (_kind, _socket, _inputs) in COLORS.items():
    value("Colors", _name, _of_noise(_kind, _socket, 0, _inputs, True))
for _mode in ("RGB", "HSV", "HSL"):
    value("Colors", f"Separate and Combine Color, {_mode}", (lambda mode: lambda net: _swapped(net, mode))(_mode))
value("Colors", "Separate and Combine XYZ", lambda net: _swapped(net, None))
value("Colors", "RGB", lambda net: net.out("RGB"))
value(
    "Colors",
    "color as a number",
    lambda net: net.out("Math", inputs={0: _noise(net, "Color"), 1: 1.0}, operation="MULTIPLY"),
)
value(
    "Colors",
    "vector as a number",
    lambda net: net.out("Math", inputs={0: net.out("TexCoord", "Generated"), 1: 1.0}, operation="MULTIPLY"),
)


def _swapped(net, mode):
    """A color taken apart and put together the other way round."""
    if mode is None:
        parts = net.node("SeparateXYZ", {0: _noise(net, "Color")}).outputs
        return net.out("CombineXYZ", inputs={0: parts[2], 1: parts[0], 2: parts[1]})
    parts = net.node("SeparateColor", {0: _noise(net, "Color")}, mode=mode).outputs
    return net.out("CombineColor", inputs={0: parts[0], 1: parts[2], 2: parts[1]}, mode=mode)


for _type in ("LINEAR", "STEPPED", "SMOOTHSTEP", "SMOOTHERSTEP"):
    value("Map Range", _type, _of_noise("MapRange", 0, 0, {1: 0.35, 2: 0.6, 3: 0.1, 4: 0.9}, interpolation_type=_type))
value("Map Range", "not clamped", _of_noise("MapRange", 0, 0, {1: 0.2, 2: 0.8, 3: 0.1, 4: 0.9}, clamp=False), 1.0, 0.2)
value(
    "Map Range",
    "Vector",
    lambda net: net.out(
        "MapRange",
        "Vector",
        {"Vector": _noise(net, "Color"), "From_Min_FLOAT3": (0.3, 0.2, 0.1)},
        data_type="FLOAT_VECTOR",
    ),
    0.5,
    0.5,
)
value("Clamp", "range", _of_noise("Clamp", 0, 0, {1: 0.6, 2: 0.4}, clamp_type="RANGE"))
value(
    "Blackbody",
    "800 to 9000 K",
    lambda net: net.out(
        "Blackbody", inputs={0: net.out("MapRange", inputs={0: _noise(net), 1: 0.3, 2: 0.7, 3: 800.0, 4: 9000.0})}
    ),
    0.1,
    0.1,
)
value(
    "Wavelength",
    "380 to 720 nm",
    lambda net: net.out(
        "Wavelength", inputs={0: net.out("MapRange", inputs={0: _noise(net), 1: 0.3, 2: 0.7, 3: 380.0, 4: 720.0})}
    ),
    0.5,
    0.5,
)
value("Normal", "dot", lambda net: net.out("Normal", "Dot", {0: net.out("TexCoord", "Normal")}), 0.4, 0.5)
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
        if shade:
            net.set(node.inputs[0], _noise(net, "Color"))
        else:
            net.set(node.inputs[0], (0.3, 0.6, 0.2))
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
value("Muted", "Noise Texture", lambda net: _mute(net.node("TexNoise")).outputs[0], 1.0, 0.2)
value(
    "Muted",
    "RGB",
    lambda net: net.out(
        "Mix",
        2,
        {"Factor_Float": 0.5, "A_Color": _mute(net.node("RGB")).outputs[0], "B_Color": (0.7, 0.3, 0.1)},
        data_type="RGBA",
    ),
    1.0,
    0.1,
)


def _mute(node):
    node.mute = True
    return node


def _reroute(net):
    color = _noise(net, "Color")
    for _ in range(3):
        knot = net.tree.nodes.new("NodeReroute")
        net.tree.links.new(color, knot.inputs[0])
        color = knot.outputs[0]
    return color


value("Reroute", "three in a row", _reroute)


def _muted_link(net):
    node = net.node("Gamma", {"Color": (0.3, 0.5, 0.7), "Gamma": 1.3})
    net.tree.links.new(_noise(net, "Color"), node.inputs[0]).is_muted = True
    return node.outputs[0]


value("Muted", "link", _muted_link)
