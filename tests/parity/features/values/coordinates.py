# SPDX-License-Identifier: GPL-3.0-or-later
"""Texture coordinates, geometry, attributes, object info, normal maps and bump."""

import bpy
import numpy as np
from mathutils import Matrix

from ...scenes import place
from ..rows import value

GROUP = "Texture Coordinate"


def _coordinate(output):
    return lambda net: net.out("TexCoord", output)


for _output, _scale, _offset in (
    ("Generated", 1.0, 0.0), ("Normal", 0.5, 0.5), ("UV", 1.0, 0.0), ("Object", 0.1, 0.5), ("Camera", 0.1, 0.5),
    ("Window", 1.0, 0.0), ("Reflection", 0.5, 0.5),
):  # fmt: skip
    value(GROUP, _output, _coordinate(_output), _scale, _offset)


def _empty() -> bpy.types.Object:
    made = bpy.data.objects.new("Empty", None)
    bpy.context.scene.collection.objects.link(made)
    made.matrix_world = place((0.5, -0.3, 0.2), (20.0, 40.0, 10.0), (1.0, 2.0, 0.7))
    return made


value(GROUP, "Object, of another", lambda net: net.out("TexCoord", "Object", object=_empty()), 0.1, 0.5)
value("UV Map", "active", lambda net: net.out("UVMap"))


def second_uv() -> None:
    for found in bpy.data.meshes:
        uv = np.empty(2 * len(found.loops), np.float32)
        found.uv_layers[0].data.foreach_get("uv", uv)
        layer = found.uv_layers.new(name="Second")
        layer.data.foreach_set("uv", 0.6 * uv + 0.2)


value("UV Map", "second", lambda net: net.out("UVMap", uv_map="Second"), prepare=second_uv)

for _output, _scale, _offset in (
    ("Position", 0.1, 0.5), ("Normal", 0.5, 0.5), ("Tangent", 0.5, 0.5), ("True Normal", 0.5, 0.5),
    ("Incoming", 0.5, 0.5), ("Parametric", 1.0, 0.0), ("Backfacing", 0.5, 0.25),
):  # fmt: skip
    value("Geometry", _output, (lambda output: lambda net: net.out("NewGeometry", output))(_output), _scale, _offset)


def _turned() -> None:
    bpy.data.objects["Ground"].matrix_world = place(turn=(180.0, 0.0, 20.0))
    bpy.data.meshes["Ball"].flip_normals()


for _output in ("Normal", "True Normal", "Backfacing"):
    value(
        "Geometry",
        f"{_output}, seen from behind",
        (lambda output: lambda net: net.out("NewGeometry", output))(_output),
        0.5,
        0.5,
        _turned,
    )
value(
    "Geometry",
    "Pointiness",
    lambda net: net.out("NewGeometry", "Pointiness"),
)

CAMERA = (("View Vector", 0.5, 0.5), ("View Z Depth", 0.1, 0.0), ("View Distance", 0.1, 0.0))
for _output, _scale, _offset in CAMERA:
    value("Camera Data", _output, (lambda output: lambda net: net.out("CameraData", output))(_output), _scale, _offset)


# --- attributes ---------------------------------------------------------------------------------------


def attribute_values(kind: str, domain: str, field: str, width: int):
    """Random values in an attribute of all meshes."""

    def prepare() -> None:
        random = np.random.default_rng(3)
        for mesh in bpy.data.meshes:
            made = mesh.attributes.new("Values", kind, domain)
            values = random.random(width * len(made.data), np.float32)
            if kind in {"INT", "INT8"}:
                values = (6 * values).astype(np.int32)
            elif kind == "BOOLEAN":
                values = values > 0.5
            made.data.foreach_set(field, values)

    return prepare


ATTRIBUTES = {
    "FLOAT": ("value", 1), "INT": ("value", 1), "BOOLEAN": ("value", 1), "INT8": ("value", 1),
    "FLOAT_VECTOR": ("vector", 3), "FLOAT2": ("vector", 2), "FLOAT_COLOR": ("color", 4), "BYTE_COLOR": ("color", 4),
}  # fmt: skip
for _kind, (_field, _width) in ATTRIBUTES.items():
    for _domain in ("POINT", "CORNER", "FACE") if _kind in {"FLOAT", "FLOAT_COLOR"} else ("POINT",):
        if _kind == "FLOAT2":
            _domain = "CORNER"
        value(
            "Attribute",
            f"Color of {_kind} by {_domain}",
            lambda net: net.out("Attribute", "Color", attribute_name="Values"),
            0.2 if _kind.startswith("INT") else 1.0,
            prepare=attribute_values(_kind, _domain, _field, _width),
        )
for _output in ("Vector", "Fac", "Alpha"):
    for _kind in ("FLOAT", "FLOAT_COLOR", "FLOAT_VECTOR"):
        value(
            "Attribute",
            f"{_output} of {_kind}",
            (lambda output: lambda net: net.out("Attribute", output, attribute_name="Values"))(_output),
            prepare=attribute_values(_kind, "POINT", *ATTRIBUTES[_kind]),
        )
value(
    "Attribute",
    "of an edge",
    lambda net: net.out("Attribute", "Fac", attribute_name="Values"),
    1.0,
    0.2,
    prepare=attribute_values("FLOAT", "EDGE", "value", 1),
)
value("Attribute", "missing", lambda net: net.out("Attribute", "Color", attribute_name="Nothing"), 1.0, 0.2, warns=True)


def _properties() -> None:
    for number, one in enumerate((bpy.data.objects["Ball"], bpy.data.objects["Ground"])):
        one["Own"] = (0.3, 0.6, 0.1 + 0.4 * number)
        one.color = (0.8, 0.3 + 0.4 * number, 0.2, 0.6)
        one.pass_index = 3 + 2 * number
        one.data["Own"] = 0.3
    bpy.context.scene["Own"] = 0.4


for _kind in ("OBJECT", "INSTANCER", "VIEW_LAYER"):
    value(
        "Attribute",
        f"custom property, {_kind}",
        (lambda kind: lambda net: net.out("Attribute", "Color", attribute_name="Own", attribute_type=kind))(_kind),
        1.0,
        0.1,
        _properties,
    )
value(
    "Attribute",
    "property color, OBJECT",
    lambda net: net.out("Attribute", "Color", attribute_name="color", attribute_type="OBJECT"),
    prepare=_properties,
)
value(
    "Color Attribute",
    "named",
    lambda net: net.out("VertexColor", "Color", layer_name="Values"),
    prepare=attribute_values("BYTE_COLOR", "CORNER", "color", 4),
)
value(
    "Color Attribute",
    "in use",
    lambda net: net.out("VertexColor", "Color"),
    prepare=attribute_values("FLOAT_COLOR", "POINT", "color", 4),
)
value(
    "Color Attribute",
    "Alpha",
    lambda net: net.out("VertexColor", "Alpha", layer_name="Values"),
    prepare=attribute_values("FLOAT_COLOR", "POINT", "color", 4),
)


for _output, _scale, _offset in (
    ("Location", 0.3, 0.3), ("Color", 1.0, 0.0), ("Alpha", 1.0, 0.0), ("Object Index", 0.1, 0.0),
    ("Material Index", 0.1, 0.1), ("Random", 1.0, 0.0),
):  # fmt: skip
    value(
        "Object Info",
        _output,
        (lambda output: lambda net: net.out("ObjectInfo", output))(_output),
        _scale,
        _offset,
        _properties,
    )


def _with_material_index(net):
    bpy.data.materials["Feature"].pass_index = 4
    return net.out("ObjectInfo", "Material Index")


value("Object Info", "Material Index, set", _with_material_index, 0.1)

# --- tangents, normal maps and bump -------------------------------------------------------------------


def _ball_alone() -> None:
    """A plane's tangents about its own axes have no length, of which Cycles makes NaN."""
    bpy.data.objects.remove(bpy.data.objects["Ground"])


for _axis in "XYZ":
    value(
        "Tangent",
        f"Radial {_axis}",
        (lambda axis: lambda net: net.out("Tangent", axis=axis))(_axis),
        0.5,
        0.5,
        _ball_alone,
    )
value("Tangent", "UV Map", lambda net: net.out("Tangent", direction_type="UV_MAP"), 0.5, 0.5)
value(
    "Tangent",
    "UV Map, named",
    lambda net: net.out("Tangent", direction_type="UV_MAP", uv_map="Second"),
    0.5,
    0.5,
    prepare=second_uv,
)


def _bumpy_color(net):
    """Colors of normals that lean up to 0.4 to all sides."""
    waves = net.out("TexNoise", "Color", {"Scale": 3.0, "Detail": 0.0})
    return net.out("VectorMath", inputs={0: waves, 1: (0.8, 0.8, 0.3), 2: (0.1, 0.1, 0.7)}, operation="MULTIPLY_ADD")


for _space in ("TANGENT", "OBJECT", "WORLD", "BLENDER_OBJECT", "BLENDER_WORLD"):
    for _strength in (1.0, 0.4):
        value(
            "Normal Map",
            f"{_space}, strength {_strength}",
            (
                lambda space, strength: (
                    lambda net: net.out(
                        "NormalMap", inputs={"Color": _bumpy_color(net), "Strength": strength}, space=space
                    )
                )
            )(_space, _strength),
            0.5,
            0.5,
        )
value(
    "Normal Map",
    "TANGENT, strength 2",
    lambda net: net.out("NormalMap", inputs={"Color": _bumpy_color(net), "Strength": 2.0}),
    0.5,
    0.5,
)
value(
    "Normal Map",
    "TANGENT, named UV map",
    lambda net: net.out("NormalMap", inputs={"Color": _bumpy_color(net)}, uv_map="Second"),
    0.5,
    0.5,
    prepare=second_uv,
)
value(
    "Normal Map",
    "TANGENT, seen from behind",
    lambda net: net.out("NormalMap", inputs={"Color": _bumpy_color(net)}),
    0.5,
    0.5,
    prepare=_turned,
)


def _bump(inputs, **properties):
    def give(net):
        height = net.out("TexNoise", "Fac", {"Scale": 2.5, "Detail": 0.0})
        return net.out("Bump", inputs={"Height": height} | inputs, **properties)

    return give


value("Bump", "noise", _bump({"Distance": 0.3}), 0.5, 0.5)
value("Bump", "inverted, strength 0.6", _bump({"Distance": 0.3, "Strength": 0.6}, invert=True), 0.5, 0.5)
value("Bump", "filter width 1", _bump({"Distance": 0.3, "Filter Width": 1.0}), 0.5, 0.5)
value("Bump", "no height", lambda net: net.out("Bump"), 0.5, 0.5)
value(
    "Bump",
    "the same height everywhere, over a gray",
    lambda net: net.out("Bump", inputs={"Height": 6.0, "Normal": net.out("TexNoise", inputs={"Scale": 4.0})}),
)
value("Bump", "seen from behind", _bump({"Distance": 0.3}), 0.5, 0.5, prepare=_turned)


def _far_and_parallel() -> None:
    """Set up a far orthographic camera: the part that a pixel sees does not grow with the distance."""
    camera = bpy.context.scene.camera
    camera.data.type, camera.data.ortho_scale = "ORTHO", 3.0
    camera.data.clip_end = 1000.0
    camera.matrix_world = camera.matrix_world @ Matrix.Translation((0.0, 0.0, 30.0))


value("Bump", "orthographic camera", _bump({"Distance": 0.3, "Filter Width": 1.0}), 0.5, 0.5, _far_and_parallel)
value("Wireframe", "pixels, orthographic camera", lambda net: net.out("Wireframe", inputs={"Size": 3.0},
      use_pixel_size=True), prepare=_far_and_parallel)  # fmt: skip


def _bump_on_map(net):
    mapped = net.out("NormalMap", inputs={"Color": _bumpy_color(net)})
    return _bump({"Distance": 0.2, "Normal": mapped})(net)


value("Bump", "over a normal map", _bump_on_map, 0.5, 0.5)

for _from, _to in (("WORLD", "OBJECT"), ("OBJECT", "WORLD"), ("CAMERA", "WORLD"), ("OBJECT", "CAMERA")):
    for _kind in ("POINT", "VECTOR", "NORMAL"):
        value(
            "Vector Transform",
            f"{_kind} {_from} to {_to}",
            (
                lambda kind, start, end: (
                    lambda net: net.out(
                        "VectorTransform",
                        inputs={0: net.out("TexCoord", "Normal")},
                        vector_type=kind,
                        convert_from=start,
                        convert_to=end,
                    )
                )
            )(_kind, _from, _to),
            0.1,
            0.7,
        )

for _output in ("Fresnel", "Facing"):
    value("Layer Weight", _output, (lambda output: lambda net: net.out("LayerWeight", output, {"Blend": 0.4}))(_output))
value("Fresnel", "IOR 1.45", lambda net: net.out("Fresnel", inputs={"IOR": 1.45}))
value("Fresnel", "seen from behind", lambda net: net.out("Fresnel", inputs={"IOR": 1.45}), 1.0, 0.1, _turned)
value("Fresnel", "of a bump", lambda net: net.out("Fresnel", inputs={"Normal": _bump({"Distance": 0.3})(net)}))
value(
    "Layer Weight", "of a bump", lambda net: net.out("LayerWeight", "Facing", {"Normal": _bump({"Distance": 0.3})(net)})
)
value("Wireframe", "meters", lambda net: net.out("Wireframe", inputs={"Size": 0.06}), 1.0, 0.1)
value("Wireframe", "pixels", lambda net: net.out("Wireframe", inputs={"Size": 2.0}, use_pixel_size=True), 1.0, 0.1)
