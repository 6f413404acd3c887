# SPDX-License-Identifier: GPL-3.0-or-later
"""Texture coordinates, geometry, attributes, object info, normal maps and bump."""

import bpy
import numpy as np
from mathutils import Matrix

from ...net import socket
from ...scenes import link_object, place
from ..rows import value

GROUP = "Texture Coordinate"
SIGNED = (0.5, 0.5)
"""Scale and offset that show numbers from -1 to 1."""


def outputs(group: str, kind: str, shown: dict[str, tuple[float, float]], prepare=None) -> None:
    """Rows of outputs of a node, by name with their scale and offset."""
    for output, (scale, offset) in shown.items():
        value(group, output, socket(kind, output), scale, offset, prepare)


outputs(GROUP, "TexCoord", {
    "Generated": (1.0, 0.0), "Normal": SIGNED, "UV": (1.0, 0.0), "Object": (0.1, 0.5), "Camera": (0.1, 0.5),
    "Window": (1.0, 0.0), "Reflection": SIGNED,
})  # fmt: skip


def _empty() -> bpy.types.Object:
    return link_object(None, place((0.5, -0.3, 0.2), (20.0, 40.0, 10.0), (1.0, 2.0, 0.7)), "Empty")


value(GROUP, "Object, of another", lambda net: net.out("TexCoord", "Object", object=_empty()), 0.1, 0.5)
value("UV Map", "active", socket("UVMap"))


def second_uv() -> None:
    for found in bpy.data.meshes:
        uv = np.empty(2 * len(found.loops), np.float32)
        found.uv_layers[0].data.foreach_get("uv", uv)
        layer = found.uv_layers.new(name="Second")
        layer.data.foreach_set("uv", 0.6 * uv + 0.2)


value("UV Map", "second", socket("UVMap", uv_map="Second"), prepare=second_uv)

outputs("Geometry", "NewGeometry", {
    "Position": (0.1, 0.5), "Normal": SIGNED, "Tangent": SIGNED, "True Normal": SIGNED, "Incoming": SIGNED,
    "Parametric": (1.0, 0.0), "Backfacing": (0.5, 0.25),
})  # fmt: skip


def _turned() -> None:
    bpy.data.objects["Ground"].matrix_world = place(turn=(180.0, 0.0, 20.0))
    bpy.data.meshes["Ball"].flip_normals()


for _output in ("Normal", "True Normal", "Backfacing"):
    value("Geometry", f"{_output}, seen from behind", socket("NewGeometry", _output), *SIGNED, _turned)
value("Geometry", "Pointiness", socket("NewGeometry", "Pointiness"))
outputs("Camera Data", "CameraData", {
    "View Vector": SIGNED, "View Z Depth": (0.1, 0.0), "View Distance": (0.1, 0.0),
})  # fmt: skip


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


def _attribute(output: str = "Color", name: str = "Values", **properties: str):
    return socket("Attribute", output, attribute_name=name, **properties)


ATTRIBUTES = {
    "FLOAT": ("value", 1), "INT": ("value", 1), "BOOLEAN": ("value", 1), "INT8": ("value", 1),
    "FLOAT_VECTOR": ("vector", 3), "FLOAT2": ("vector", 2), "FLOAT_COLOR": ("color", 4), "BYTE_COLOR": ("color", 4),
}  # fmt: skip
DOMAINS = dict.fromkeys(("FLOAT", "FLOAT_COLOR"), ("POINT", "CORNER", "FACE")) | {"FLOAT2": ("CORNER",)}
for _kind, _field in ATTRIBUTES.items():
    _scale = 0.2 if _kind.startswith("INT") else 1.0
    for _domain in DOMAINS.get(_kind, ("POINT",)):
        _prepare = attribute_values(_kind, _domain, *_field)
        value("Attribute", f"Color of {_kind} by {_domain}", _attribute(), _scale, prepare=_prepare)
for _output in ("Vector", "Fac", "Alpha"):
    for _kind in ("FLOAT", "FLOAT_COLOR", "FLOAT_VECTOR"):
        _prepare = attribute_values(_kind, "POINT", *ATTRIBUTES[_kind])
        value("Attribute", f"{_output} of {_kind}", _attribute(_output), prepare=_prepare)
value("Attribute", "of an edge", _attribute("Fac"), 1.0, 0.2, attribute_values("FLOAT", "EDGE", "value", 1))
for _name, _output in (("generated", "Vector"), ("generated", "Fac"), ("pointiness", "Fac")):
    value("Attribute", f"{_output} of {_name}", _attribute(_output, name=_name), 1.0, 0.2)
value("Attribute", "missing", _attribute(name="Nothing"), 1.0, 0.2, warns=True)


def _properties() -> None:
    for number, one in enumerate((bpy.data.objects["Ball"], bpy.data.objects["Ground"])):
        one["Own"] = (0.3, 0.6, 0.1 + 0.4 * number)
        one.color = (0.8, 0.3 + 0.4 * number, 0.2, 0.6)
        one.pass_index = 3 + 2 * number
        one.data["Own"] = 0.3
    bpy.context.scene["Own"] = 0.4


for _kind in ("OBJECT", "INSTANCER", "VIEW_LAYER"):
    _give = _attribute(name="Own", attribute_type=_kind)
    value("Attribute", f"custom property, {_kind}", _give, 1.0, 0.1, _properties)
value("Attribute", "property color, OBJECT", _attribute(name="color", attribute_type="OBJECT"), prepare=_properties)
for _name, _output, _layer, _kind, _domain in (
    ("named", "Color", "Values", "BYTE_COLOR", "CORNER"),
    ("in use", "Color", "", "FLOAT_COLOR", "POINT"),
    ("Alpha", "Alpha", "Values", "FLOAT_COLOR", "POINT"),
):
    _give = socket("VertexColor", _output, layer_name=_layer)
    value("Color Attribute", _name, _give, prepare=attribute_values(_kind, _domain, "color", 4))
outputs("Object Info", "ObjectInfo", {
    "Location": (0.3, 0.3), "Color": (1.0, 0.0), "Alpha": (1.0, 0.0), "Object Index": (0.1, 0.0),
    "Material Index": (0.1, 0.1), "Random": (1.0, 0.0),
}, _properties)  # fmt: skip


def _with_material_index(net):
    bpy.data.materials["Feature"].pass_index = 4
    return net.out("ObjectInfo", "Material Index")


value("Object Info", "Material Index, set", _with_material_index, 0.1)


def _instanced() -> None:
    """The ball as the instance of a collection whose instancer has a color of its own."""
    _properties()
    ball, scene = bpy.data.objects["Ball"], bpy.context.scene
    collection = bpy.data.collections.new("Balls")
    scene.collection.objects.unlink(ball)
    collection.objects.link(ball)
    empty = link_object(None, name="Empty")
    empty.instance_type, empty.instance_collection, empty.color = "COLLECTION", collection, (0.1, 0.4, 0.9, 0.3)


for _output in ("Color", "Alpha"):
    value("Object Info", f"{_output} of instances", socket("ObjectInfo", _output), prepare=_instanced)

# --- tangents, normal maps and bump -------------------------------------------------------------------


def _ball_alone() -> None:
    """A plane's tangents about its own axes have no length, of which Cycles makes NaN."""
    bpy.data.objects.remove(bpy.data.objects["Ground"])


def directions(group: str, rows: dict, prepare=None) -> None:
    """Rows of vectors by name, from -1 to 1."""
    for name, give in rows.items():
        value(group, name, give, *SIGNED, prepare)


directions("Tangent", {f"Radial {axis}": socket("Tangent", axis=axis) for axis in "XYZ"}, _ball_alone)
directions("Tangent", {"UV Map": socket("Tangent", direction_type="UV_MAP")})
directions("Tangent", {"UV Map, named": socket("Tangent", direction_type="UV_MAP", uv_map="Second")}, second_uv)

_WAVES = socket("TexNoise", "Color", {"Scale": 3.0, "Detail": 0.0})
_BUMPY = socket("VectorMath", 0, {0: _WAVES, 1: (0.8, 0.8, 0.3), 2: (0.1, 0.1, 0.7)}, operation="MULTIPLY_ADD")
"""Colors of normals that lean up to 0.4 to all sides."""


def _normal_map(inputs=None, **properties):
    return socket("NormalMap", 0, {"Color": _BUMPY} | (inputs or {}), **properties)


for _space in ("TANGENT", "OBJECT", "WORLD", "BLENDER_OBJECT", "BLENDER_WORLD"):
    for _strength in (1.0, 0.4):
        _give = _normal_map({"Strength": _strength}, space=_space)
        directions("Normal Map", {f"{_space}, strength {_strength}": _give})
directions("Normal Map", {"TANGENT, strength 2": _normal_map({"Strength": 2.0})})
directions("Normal Map", {"TANGENT, named UV map": _normal_map(uv_map="Second")}, second_uv)
directions("Normal Map", {"TANGENT, seen from behind": _normal_map()}, _turned)


def _bump(inputs, **properties):
    height = socket("TexNoise", "Fac", {"Scale": 2.5, "Detail": 0.0})
    return socket("Bump", 0, {"Height": height} | inputs, **properties)


def _far_and_parallel() -> None:
    """Set up a far orthographic camera: the part that a pixel sees does not grow with the distance."""
    camera = bpy.context.scene.camera
    camera.data.type, camera.data.ortho_scale = "ORTHO", 3.0
    camera.data.clip_end = 1000.0
    camera.matrix_world = camera.matrix_world @ Matrix.Translation((0.0, 0.0, 30.0))


NOISE_BUMP = _bump({"Distance": 0.3})
WIDE_BUMP = _bump({"Distance": 0.3, "Filter Width": 1.0})
directions("Bump", {
    "noise": NOISE_BUMP, "inverted, strength 0.6": _bump({"Distance": 0.3, "Strength": 0.6}, invert=True),
    "filter width 1": WIDE_BUMP, "no height": socket("Bump"),
})  # fmt: skip
_gray = socket("TexNoise", inputs={"Scale": 4.0})
value("Bump", "the same height everywhere, over a gray", socket("Bump", inputs={"Height": 6.0, "Normal": _gray}))
directions("Bump", {"seen from behind": NOISE_BUMP}, _turned)
directions("Bump", {"orthographic camera": WIDE_BUMP}, _far_and_parallel)
_PIXELS = {"use_pixel_size": True}
value("Wireframe", "pixels, orthographic camera", socket("Wireframe", inputs={"Size": 3.0}, **_PIXELS),
      prepare=_far_and_parallel)  # fmt: skip


def _bump_on_map(net):
    mapped = _normal_map()(net)
    return _bump({"Distance": 0.2, "Normal": mapped})(net)


directions("Bump", {"over a normal map": _bump_on_map})

for _from, _to in (("WORLD", "OBJECT"), ("OBJECT", "WORLD"), ("CAMERA", "WORLD"), ("OBJECT", "CAMERA")):
    for _kind in ("POINT", "VECTOR", "NORMAL"):
        _options = {"vector_type": _kind, "convert_from": _from, "convert_to": _to}
        _give = socket("VectorTransform", inputs={0: socket("TexCoord", "Normal")}, **_options)
        value("Vector Transform", f"{_kind} {_from} to {_to}", _give, 0.1, 0.7)

for _output in ("Fresnel", "Facing"):
    value("Layer Weight", _output, socket("LayerWeight", _output, {"Blend": 0.4}))
value("Fresnel", "IOR 1.45", socket("Fresnel", inputs={"IOR": 1.45}))
value("Fresnel", "seen from behind", socket("Fresnel", inputs={"IOR": 1.45}), 1.0, 0.1, _turned)
value("Fresnel", "of a bump", socket("Fresnel", inputs={"Normal": NOISE_BUMP}))
value("Layer Weight", "of a bump", socket("LayerWeight", "Facing", {"Normal": NOISE_BUMP}))
value("Wireframe", "meters", socket("Wireframe", inputs={"Size": 0.06}), 1.0, 0.1)
value("Wireframe", "pixels", socket("Wireframe", inputs={"Size": 2.0}, **_PIXELS), 1.0, 0.1)
