# SPDX-License-Identifier: GPL-3.0-or-later
"""Texture coordinates, attributes and images on each kind of object, as glowing colors that show their values."""

import functools
from collections.abc import Callable

import bpy
import numpy as np

from .files import cube, file, monkey, paint, plain, start

COORDINATES = ("Generated", "Normal", "UV", "Object", "Camera", "Window", "Reflection")


def _without_uv() -> bpy.types.Object:
    thing = monkey()
    while thing.data.uv_layers:
        thing.data.uv_layers.remove(thing.data.uv_layers[0])
    return thing


def _bevelled_curve() -> bpy.types.Object:
    bpy.ops.curve.primitive_bezier_circle_add()
    bpy.context.object.data.bevel_depth = 0.3
    return bpy.context.object


def _text() -> bpy.types.Object:
    bpy.ops.object.text_add(location=(-0.8, -0.3, 0.0), rotation=(0.9, 0.0, 0.7))
    bpy.context.object.data.extrude = 0.15
    return bpy.context.object


def _surface() -> bpy.types.Object:
    bpy.ops.surface.primitive_nurbs_surface_torus_add()
    return bpy.context.object


def _metaball() -> bpy.types.Object:
    bpy.ops.object.metaball_add(type="ELLIPSOID", radius=1.2)
    return bpy.context.object


def _points() -> bpy.types.Object:
    bpy.ops.object.pointcloud_random_add()
    return bpy.context.object


def _subdivided() -> bpy.types.Object:
    thing = cube()
    thing.modifiers.new("Subdivision", "SUBSURF")
    thing.location, thing.scale = (0.2, 0.1, 0.0), (1.0, 0.7, 1.2)
    return thing


def _instanced() -> bpy.types.Object:
    thing = cube(0.8)
    collection = bpy.data.collections.new("Group")
    bpy.context.scene.collection.children.link(collection)
    collection.objects.link(thing)
    bpy.ops.object.collection_instance_add(collection="Group", location=(0.9, -0.9, 0.3), rotation=(0.3, 0.4, 0.5))
    return thing


TYPES = {"INT": np.int32, "INT8": np.int32, "BOOLEAN": bool}
OBJECTS: dict[str, Callable[[], bpy.types.Object]] = {
    "without_uv": _without_uv,
    "curve": _bevelled_curve,
    "text": _text,
    "surface": _surface,
    "metaball": _metaball,
    "points": _points,
    "subdivided": _subdivided,
    "instanced": _instanced,
}


def glowing(thing: bpy.types.Object) -> tuple[bpy.types.NodeTree, bpy.types.NodeSocket]:
    """Have an object glow by a vector that is yet to be linked: a quarter of it and a half."""
    material = plain((0.8, 0.8, 0.8))
    tree = material.node_tree
    tree.nodes.remove(tree.nodes["Principled BSDF"])
    half, emission = tree.nodes.new("ShaderNodeVectorMath"), tree.nodes.new("ShaderNodeEmission")
    half.operation = "MULTIPLY_ADD"
    half.inputs[1].default_value, half.inputs[2].default_value = (0.25, 0.25, 0.25), (0.5, 0.5, 0.5)
    tree.links.new(half.outputs[0], emission.inputs["Color"])
    tree.links.new(emission.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
    paint(thing, material)
    return tree, half.inputs[0]


def _coordinates(make: Callable[[], bpy.types.Object], name: str) -> None:
    start()
    tree, vector = glowing(make())
    tree.links.new(tree.nodes.new("ShaderNodeTexCoord").outputs[name], vector)


for kind, make in OBJECTS.items():
    for name in COORDINATES if kind in {"curve", "instanced"} else COORDINATES[:4]:
        file(f"coordinates_{kind}_{name.lower()}", functools.partial(_coordinates, make, name))


def _attribute(name: str, make: Callable[[], bpy.types.Object]) -> None:
    """Attributes that are not there, and those that Blender has on its own."""
    start()
    thing = make()
    tree, vector = glowing(thing)
    if name == "color_attribute":
        node = tree.nodes.new("ShaderNodeVertexColor")
    elif name == "uv_map":
        node = tree.nodes.new("ShaderNodeUVMap")
    elif name == "tangent":
        node = tree.nodes.new("ShaderNodeTangent")
        node.direction_type = "UV_MAP"
    else:
        node = tree.nodes.new("ShaderNodeAttribute")
        node.attribute_name = name
    tree.links.new(node.outputs[0], vector)


for name in ("missing", "position", "UVMap", "color_attribute", "uv_map", "tangent", "crease_edge"):
    for kind, make in {"mesh": monkey, "without_uv": _without_uv, "curve": _bevelled_curve}.items():
        file(f"attribute_{name.lower()}_{kind}", functools.partial(_attribute, name, make))


def _domain(domain: str, kind: str) -> None:
    start()
    thing = monkey()
    attribute = thing.data.attributes.new("Painted", kind, domain)
    generator = np.random.default_rng(5)
    channels, member = {
        "FLOAT": (1, "value"),
        "INT": (1, "value"),
        "BOOLEAN": (1, "value"),
        "FLOAT2": (2, "vector"),
        "FLOAT_VECTOR": (3, "vector"),
        "FLOAT_COLOR": (4, "color"),
        "BYTE_COLOR": (4, "color"),
        "INT8": (1, "value"),
    }[kind]
    values = generator.random(len(attribute.data) * channels) * (3.0 if kind.startswith("INT") else 1.0)
    attribute.data.foreach_set(member, values.astype(TYPES.get(kind, np.float32)))
    tree, vector = glowing(thing)
    node = tree.nodes.new("ShaderNodeAttribute")
    node.attribute_name = "Painted"
    tree.links.new(node.outputs["Color"], vector)


for domain in ("POINT", "CORNER", "FACE", "EDGE"):
    for kind in ("FLOAT", "FLOAT_COLOR"):
        file(f"attribute_{domain.lower()}_{kind.lower()}", functools.partial(_domain, domain, kind))
for kind in ("INT", "BOOLEAN", "FLOAT2", "FLOAT_VECTOR", "BYTE_COLOR", "INT8"):
    file(f"attribute_point_{kind.lower()}", functools.partial(_domain, "POINT", kind))


def picture(alpha: bool = False) -> bpy.types.Image:
    """A small picture with colors, a corner of which has alpha."""
    image = bpy.data.images.new("Picture", 12, 8, alpha=alpha)
    pixels = np.random.default_rng(7).random((8, 12, 4), np.float32)
    pixels[..., 3] = 1.0
    if alpha:
        pixels[:4, :6, 3] = 0.3
    image.pixels.foreach_set(pixels.ravel())
    image.pack()
    return image


def _image(change: str) -> None:
    start()
    thing = cube()
    material = thing.data.materials[0]
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = picture(alpha="alpha" in change)
    principled = tree.nodes["Principled BSDF"]
    tree.links.new(node.outputs["Color"], principled.inputs["Base Color"])
    if change.startswith("alpha"):
        tree.links.new(node.outputs["Alpha"], principled.inputs["Alpha"])
        node.image.alpha_mode = {"alpha": "STRAIGHT", "alpha_premultiplied": "PREMUL", "alpha_packed": "CHANNEL_PACKED",
                                 "alpha_none": "NONE"}[change]  # fmt: skip
    elif change in {"CLIP", "EXTEND", "MIRROR"}:
        node.extension = change
        mapping, coordinates = tree.nodes.new("ShaderNodeMapping"), tree.nodes.new("ShaderNodeTexCoord")
        mapping.inputs["Scale"].default_value = (3.0, 3.0, 3.0)
        tree.links.new(coordinates.outputs["UV"], mapping.inputs[0])
        tree.links.new(mapping.outputs[0], node.inputs[0])
    elif change in {"BOX", "SPHERE", "TUBE"}:
        node.projection = change
        tree.links.new(tree.nodes.new("ShaderNodeTexCoord").outputs["Generated"], node.inputs[0])
    elif change in {"Non-Color", "Linear Rec.709", "Filmic sRGB"}:
        node.image.colorspace_settings.name = change
    elif change in {"Closest", "Cubic", "Smart"}:
        node.interpolation = change
    elif change == "lost":
        node.image = bpy.data.images.new("Lost", 4, 4)
        node.image.source, node.image.filepath = "FILE", "//no/such/picture.png"
    elif change == "generated":
        node.image = bpy.data.images.new("Grid", 64, 64)
        node.image.generated_type = "COLOR_GRID"
    elif change == "normal_map":
        tree.links.clear()
        tree.links.new(principled.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
        normal = tree.nodes.new("ShaderNodeNormalMap")
        tree.links.new(node.outputs["Color"], normal.inputs["Color"])
        tree.links.new(normal.outputs[0], principled.inputs["Normal"])


for change in (
    *("plain", "alpha", "alpha_premultiplied", "alpha_packed", "alpha_none", "CLIP", "EXTEND", "MIRROR", "BOX"),
    *("SPHERE", "TUBE", "Non-Color", "Linear Rec.709", "Filmic sRGB", "Closest", "Cubic", "Smart", "lost"),
    *("generated", "normal_map"),
):
    file(f"image_{change.lower().replace(' ', '_').replace('.', '')}", functools.partial(_image, change))
