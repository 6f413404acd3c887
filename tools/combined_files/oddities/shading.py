# SPDX-License-Identifier: GPL-3.0-or-later
"""Node groups, muted nodes, image textures of every alpha mode, and materials as old files have them."""

from typing import Any

import bpy
import numpy as np

from .. import images
from ..draws import Draws
from ..graphs import Graph, finish, material
from ..scenes import Place, add, shape
from .parts import matte, part


def _sample(paint: bpy.types.Material, at: Place, kind: str = "uvsphere") -> bpy.types.Object:
    return add("Sample", shape(kind, paint, kind == "uvsphere"), (at[0], at[1], 0.41), (0.2, 0.1, 0.5), (0.8,) * 3)


def _group(name: str, inputs: dict[str, str], outputs: dict[str, str]) -> tuple[Graph, Any, Any]:
    tree = bpy.data.node_groups.new(name, "ShaderNodeTree")
    for names, way in ((inputs, "INPUT"), (outputs, "OUTPUT")):
        for socket, kind in names.items():
            tree.interface.new_socket(socket, in_out=way, socket_type=f"NodeSocket{kind}")
    return Graph(tree), tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")


def _use(graph: Graph, tree: bpy.types.NodeTree, **inputs: Any) -> bpy.types.Node:
    node = graph.tree.nodes.new("ShaderNodeGroup")
    node.node_tree = tree
    for name, value in inputs.items():
        if isinstance(value, bpy.types.NodeSocket):
            graph.tree.links.new(value, node.inputs[name])
        else:
            node.inputs[name].default_value = value
    return node


@part
def nested_groups(draws: Draws, at: Place) -> None:
    """A group in a group, with frames, reroutes, a muted node, and inputs at their defaults."""
    inner, given, out = _group("Inner", {"Factor": "Float", "Tint": "Color"}, {"Color": "Color", "Value": "Float"})
    reroute = inner.tree.nodes.new("NodeReroute")
    inner.tree.links.new(given.outputs["Tint"], reroute.inputs[0])
    frame = inner.tree.nodes.new("NodeFrame")
    reroute.parent = frame
    checker = inner.node("TexChecker", None, {1: reroute.outputs[0], 2: draws.color(), 3: 4.0})
    inner.tree.links.new(inner.mixed(given.outputs["Factor"], checker, (0.9, 0.8, 0.1, 1)), out.inputs["Color"])
    inner.tree.links.new(inner.math("SQRT", given.outputs["Factor"]).outputs[0], out.inputs["Value"])
    outer, given, out = _group("Outer", {"Amount": "Float", "Tint": "Color"}, {"Shader": "Shader"})
    outer.tree.interface.items_tree["Tint"].default_value = draws.color(0.9)
    used = _use(outer, inner.tree, Factor=given.outputs["Amount"], Tint=given.outputs["Tint"])
    bright = outer.node("BrightContrast", Color=used.outputs["Color"], Bright=0.5)
    bright.mute = draws.maybe()
    shader = outer.node("BsdfPrincipled", Base_Color=bright, Roughness=used.outputs["Value"])
    outer.tree.links.new(shader.outputs[0], out.inputs["Shader"])
    made, graph = material("Nested")
    finish(graph, _use(graph, outer.tree, Amount=draws.random()).outputs[0])
    _sample(made, at)


@part
def output_in_a_group(draws: Draws, at: Place) -> None:
    """The Material Output inside a group, beside one at the top that is not active."""
    inner, _, _ = _group("With Output", {}, {})
    finish(inner, inner.node("BsdfDiffuse", Color=draws.color(0.9)))
    made, graph = material("Output in a Group")
    _use(graph, inner.tree)
    _sample(made, at)


@part
def muted(draws: Draws, at: Place) -> None:
    """Muted nodes of many kinds and a muted link."""
    made, graph = material("Muted")
    checker = graph.node("TexChecker", None, {1: draws.color(), 2: draws.color(), 3: 5.0})
    color = graph.mixed(0.8, checker, (0.1, 0.1, 0.9, 1.0), "MULTIPLY")
    color.node.mute = draws.maybe()
    ramp = graph.ramp(color, [(0.2, draws.color()), (0.8, draws.color())])
    ramp.mute = draws.maybe()
    gamma = graph.node("Gamma", Color=ramp, Gamma=2.0)
    gamma.mute = draws.maybe()
    first = graph.node("BsdfDiffuse", Color=gamma)
    second = graph.node("BsdfPrincipled", Base_Color=draws.color(), Roughness=0.5)
    mix = graph.node("MixShader", None, {0: 0.3, 1: first, 2: second})
    mix.mute = draws.maybe()
    finish(graph, mix)
    bump = graph.node("Bump", Height=checker.outputs[1], Distance=0.05)
    bump.mute = draws.maybe()
    link = graph.tree.links.new(bump.outputs[0], second.inputs["Normal"])
    link.is_muted = draws.maybe(0.3)
    _sample(made, at)


@part
def muted_texture(draws: Draws, at: Place) -> None:
    """A muted image texture and a muted shader with nothing before it."""
    made, graph = material("Muted Texture")
    picture = graph.node("TexImage", {"image": images.image("Muted", images.colored(draws))})
    picture.mute = True
    shader = graph.node("BsdfDiffuse", Color=picture)
    shine = graph.node("BsdfAnisotropic")
    shine.mute = draws.maybe()
    finish(graph, graph.node("AddShader", None, {0: shader, 1: shine}))
    _sample(made, at)


def _with_alpha(draws: Draws) -> np.ndarray:
    pixels = images.colored(draws)
    height, width = pixels.shape[:2]
    pixels = np.concatenate([pixels[..., :3], np.ones((height, width, 1))], axis=-1).astype(np.float32)
    pixels[..., 3] = np.linspace(0.0, 1.0, width)[None, :]
    return pixels


def _kept(name: str, pixels: np.ndarray, form: str, mode: str, is_float: bool, space: str) -> bpy.types.Image:
    """An image that is packed as a file of a format."""
    height, width = pixels.shape[:2]
    made = bpy.data.images.new(name, width, height, alpha=True, float_buffer=is_float)
    made.pixels.foreach_set(np.ascontiguousarray(pixels, np.float32).ravel())
    made.file_format = form
    made.pack()
    made.colorspace_settings.name = space
    made.alpha_mode = mode
    return made


@part
def alpha_modes(draws: Draws, at: Place) -> None:
    """A decal whose image has alpha in one of four modes, over a checkered box."""
    made, graph = material("Decal")
    mode = draws.pick(("STRAIGHT", "PREMUL", "CHANNEL_PACKED", "NONE"))
    form, is_float = draws.pick((("PNG", False), ("OPEN_EXR", True), ("TARGA", False), ("TIFF", False)))
    space = draws.pick(("sRGB", "Non-Color", "Linear Rec.709", "sRGB"))
    kept = _kept(f"{mode} {form} {space}", _with_alpha(draws), form, mode, is_float, space)
    settings = {
        "image": kept,
        "extension": draws.pick(("REPEAT", "EXTEND", "CLIP", "MIRROR")),
        "interpolation": draws.pick(("Linear", "Closest", "Cubic", "Smart")),
    }
    uv = graph.node("Mapping", Vector=graph.node("TexCoord").outputs["UV"], Scale=(1.7, 1.3, 1), Location=(-0.3, 0, 0))
    picture = graph.node("TexImage", settings, Vector=uv)
    if draws.maybe():
        finish(graph, graph.node("BsdfPrincipled", Base_Color=picture, Alpha=picture.outputs[1], Roughness=0.7))
    else:
        clear, lit = graph.node("BsdfTransparent"), graph.node("BsdfDiffuse", Color=picture)
        finish(graph, graph.node("MixShader", None, {0: picture.outputs[1], 1: clear, 2: lit}))
    add("Decal", shape("grid", made), (at[0], at[1] - 0.3, 0.4), (1.3, 0, 0), (0.8, 0.8, 1))
    add("Behind", shape("cube", matte(draws.color(0.9))), (at[0], at[1] + 0.15, 0.31), scale=(0.7, 0.1, 0.6))


@part
def generated_image(draws: Draws, at: Place) -> None:
    """Generated images of Blender's two grids and of a color, never saved."""
    made, graph = material("Generated")
    picture = bpy.data.images.new("Grid", 64, 64, float_buffer=draws.maybe())
    picture.generated_type = draws.pick(("UV_GRID", "COLOR_GRID", "BLANK"))
    picture.generated_color = draws.color(0.9)
    node = graph.node("TexImage", {"image": picture, "projection": draws.pick(("FLAT", "BOX", "SPHERE", "TUBE"))})
    node.projection_blend = draws.pick((0.0, 0.4))
    if draws.maybe():
        graph.tree.links.new(graph.node("TexCoord").outputs[draws.pick(("Generated", "Object"))], node.inputs[0])
    finish(graph, graph.node("BsdfDiffuse", Color=node))
    _sample(made, at, draws.pick(("uvsphere", "cube")))


@part
def without_nodes(draws: Draws, at: Place) -> None:
    """Materials of old files: nodes unused, slots that are empty, faces of slots that are not there."""
    old = bpy.data.materials.new("Old")
    old.diffuse_color, old.metallic, old.roughness = draws.color(0.9), draws.pick((0.0, 1.0)), 0.5
    thing = _sample(old, at, "cube")
    thing.data.materials.append(None)
    thing.data.materials.append(matte(draws.color(0.9)))
    for face in thing.data.polygons:
        face.material_index = face.index % 5


@part
def conversions(draws: Draws, at: Place) -> None:
    """Sockets of one kind linked to another: vectors as numbers, numbers as shaders, colors as shaders."""
    made, graph = material("Conversions")
    vector = graph.node("NewGeometry").outputs["Position"]
    fraction = graph.node("VectorMath", {"operation": "FRACTION"}, {0: vector})
    choice = draws.pick(("vector", "color", "shader", "boolean"))
    if choice == "vector":
        finish(graph, graph.node("BsdfPrincipled", Base_Color=fraction, Roughness=fraction, Metallic=0.0))
    elif choice == "color":
        color = graph.node("TexVoronoi", Scale=5.0).outputs["Color"]
        mix = {0: color, 1: graph.node("BsdfDiffuse"), 2: graph.node("BsdfDiffuse", Color=(0.1, 0.3, 0.8, 1))}
        finish(graph, graph.node("MixShader", None, mix))
    elif choice == "shader":
        lit = graph.node("BsdfDiffuse", Color=draws.color())
        finish(graph, graph.node("MixShader", None, {0: 0.3, 1: lit, 2: fraction}))
    else:
        finish(
            graph,
            graph.node("BsdfPrincipled", Base_Color=draws.color(), Alpha=graph.math("GREATER_THAN", fraction, 0.4)),
        )
    _sample(made, at)


@part
def cel(draws: Draws, at: Place) -> None:
    """An outline of an inverted hull by Solidify, whose back faces are culled by a shader."""
    outline, graph = material("Outline")
    facing = graph.node("NewGeometry").outputs["Backfacing"]
    black = graph.node("Emission", Color=(0.02, 0.01, 0.05, 1))
    camera_only = graph.math("MULTIPLY", graph.node("LightPath").outputs["Is Camera Ray"], facing)
    finish(graph, graph.node("MixShader", None, {0: camera_only, 1: graph.node("BsdfTransparent"), 2: black}))
    thing = add("Toon", shape("monkey", matte(draws.color(0.9)), True), (at[0], at[1], 0.45), (0, 0, 0.3), (0.35,) * 3)
    thing.data.materials.append(outline)
    hull = thing.modifiers.new("Hull", "SOLIDIFY")
    hull.thickness, hull.offset, hull.use_flip_normals, hull.material_offset = -0.08, 1.0, True, 1


@part
def holdout_material(draws: Draws, at: Place) -> None:
    """A Holdout mixed with a surface."""
    made, graph = material("Holdout")
    lit = graph.node("BsdfDiffuse", Color=draws.color())
    finish(graph, graph.node("MixShader", None, {0: draws.random(), 1: lit, 2: graph.node("Holdout")}))
    _sample(made, at)


@part
def bevel_and_occlusion(draws: Draws, at: Place) -> None:
    """Dirt by Ambient Occlusion and Pointiness, edges by Bevel."""
    made, graph = material("Worn")
    dirt = graph.node("AmbientOcclusion", {"samples": 8}, Distance=0.3).outputs["AO"]
    sharp = graph.node("NewGeometry").outputs["Pointiness"]
    worn = graph.node("MapRange", Value=sharp, From_Min=0.45, From_Max=0.55).outputs[0]
    color = graph.mixed(graph.math("MULTIPLY", dirt, worn), draws.color(), draws.color())
    finish(
        graph, graph.node("BsdfPrincipled", Base_Color=color, Normal=graph.node("Bevel", Radius=0.05), Roughness=0.6)
    )
    _sample(made, at, "cube")
    add("Leaning", shape("cube", made), (at[0] + 0.3, at[1] - 0.3, 0.2), (0, 0, 0.4), (0.3, 0.3, 0.4))


@part
def aov_and_layers(draws: Draws, at: Place) -> None:
    """Fake rim light by Layer Weight and normals in camera space, with an AOV output besides."""
    made, graph = material("Rim")
    normal = graph.node("VectorTransform", {"vector_type": "NORMAL", "convert_from": "WORLD", "convert_to": "CAMERA"},
                        Vector=graph.node("NewGeometry").outputs["Normal"])  # fmt: skip
    color = graph.node("VectorMath", {"operation": "MULTIPLY_ADD"}, {0: normal, 1: (0.5, 0.5, 0.5), 2: (0.5, 0.5, 0.5)})
    graph.node("OutputAOV", {"aov_name": "Normals"}, Color=color)
    rim = graph.math("POWER", graph.node("LayerWeight", Blend=0.4).outputs["Facing"], 3.0)
    lit = graph.node("BsdfDiffuse", Color=color)
    finish(graph, graph.node("MixShader", None, {0: rim, 1: lit, 2: graph.node("Emission", Color=draws.color())}))
    _sample(made, at)


@part
def object_space_bump(draws: Draws, at: Place) -> None:
    """A normal map in object space and a vector displacement, on an object scaled unevenly and mirrored."""
    made, graph = material("Vectors")
    noise = graph.node("TexNoise", Vector=graph.node("TexCoord").outputs["Object"], Scale=3.0)
    shader = graph.node("BsdfPrincipled", Base_Color=draws.color(), Roughness=0.4)
    if draws.maybe():
        space = draws.pick(("OBJECT", "WORLD", "BLENDER_OBJECT", "BLENDER_WORLD"))
        normal = graph.node("NormalMap", {"space": space}, Color=noise.outputs["Color"], Strength=0.4)
        graph.tree.links.new(normal.outputs[0], shader.inputs["Normal"])
        finish(graph, shader)
    else:
        space = draws.pick(("TANGENT", "OBJECT", "WORLD"))
        moved = graph.node(
            "VectorDisplacement", {"space": space}, Vector=noise.outputs["Color"], Midlevel=0.5, Scale=0.2
        )
        finish(graph, shader, displacement=moved)
        made.displacement_method = draws.pick(("BUMP", "DISPLACEMENT", "BOTH"))
    thing = _sample(made, at)
    thing.scale = (draws.pick((-0.8, 0.8)), 0.6, 0.7)
