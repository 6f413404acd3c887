# SPDX-License-Identifier: GPL-3.0-or-later
"""Each type of light with its defaults and at extremes, and worlds."""

import functools
import math

import bpy

from .files import aim, ball, file, monkey, plain, start

KINDS = ("POINT", "SUN", "SPOT", "AREA")


def _lamp(kind: str, values: dict[str, object]) -> None:
    start()
    monkey()
    bpy.context.scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.1
    bpy.data.objects.remove(bpy.data.objects["Light"])
    bpy.ops.object.light_add(type=kind, location=(1.2, -1.2, 1.6))
    lamp = bpy.context.object
    aim(lamp, (0.0, 0.0, 0.0))
    for name, value in values.items():
        setattr(lamp if name.startswith("visible") else lamp.data, name, value)


for kind in KINDS:
    strong = 3.0 if kind == "SUN" else 150.0
    changes = {
        "default": {},
        "usual": {"energy": strong},
        "colored": {"energy": strong, "color": (1.0, 0.2, 0.05)},
        "temperature": {"energy": strong, "use_temperature": True, "temperature": 2700.0},
        "negative": {"energy": -strong},
        "no_shadow": {"energy": strong, "use_shadow": False},
        "exposure": {"energy": strong, "exposure": 1.5},
        "diffuse_factor_0": {"energy": strong, "diffuse_factor": 0.0},
        "specular_factor_0": {"energy": strong, "specular_factor": 0.0},
        "seen": {"energy": strong, "visible_camera": True},
        "normalize_off": {"energy": 2.0, "normalize": False},
    }
    if kind in {"POINT", "SPOT"}:
        changes |= {
            "hard": {"energy": strong, "shadow_soft_size": 0.0},
            "large": {"energy": strong, "shadow_soft_size": 1.0},
            "large_not_soft": {"energy": strong, "shadow_soft_size": 0.8, "use_soft_falloff": False},
        }
    if kind == "SPOT":
        changes |= {
            "wide": {"energy": strong, "spot_size": math.pi},
            "narrow": {"energy": strong, "spot_size": 0.1},
            "blend_0": {"energy": strong, "spot_blend": 0.0},
            "blend_1": {"energy": strong, "spot_blend": 1.0},
            "square": {"energy": strong, "use_square": True},
        }
    if kind == "SUN":
        changes |= {"sharp": {"energy": strong, "angle": 0.0}, "wide": {"energy": strong, "angle": math.pi}}
    if kind == "AREA":
        changes |= {
            "disk": {"energy": strong, "shape": "DISK", "size": 1.0},
            "rectangle": {"energy": strong, "shape": "RECTANGLE", "size": 3.0, "size_y": 0.1},
            "ellipse": {"energy": strong, "shape": "ELLIPSE", "size": 2.0, "size_y": 0.5},
            "size_0": {"energy": strong, "size": 0.0},
            "spread": {"energy": strong, "spread": 0.5},
            "spread_0": {"energy": strong, "spread": 0.0},
        }
    for name, values in changes.items():
        file(f"light_{kind.lower()}_{name}", functools.partial(_lamp, kind, values))


def _lamp_nodes(kind: str) -> None:
    _lamp("POINT", {"energy": 150.0})
    data = bpy.context.object.data
    data.use_nodes = True
    tree = data.node_tree
    emission = tree.nodes["Emission"]
    if kind == "texture":
        tree.links.new(tree.nodes.new("ShaderNodeTexNoise").outputs["Color"], emission.inputs["Color"])
    elif kind == "strength":
        emission.inputs["Strength"].default_value = 3.0
    elif kind == "blackbody":
        tree.links.new(tree.nodes.new("ShaderNodeBlackbody").outputs[0], emission.inputs["Color"])
    elif kind == "falloff":
        falloff = tree.nodes.new("ShaderNodeLightFalloff")
        falloff.inputs["Smooth"].default_value = 1.0
        tree.links.new(falloff.outputs["Quadratic"], emission.inputs["Strength"])
    elif kind == "unlinked":
        tree.links.clear()
    elif kind == "ies":
        tree.links.new(tree.nodes.new("ShaderNodeTexIES").outputs[0], emission.inputs["Strength"])


for kind in ("as_they_are", "texture", "strength", "blackbody", "falloff", "unlinked", "ies"):
    file(f"light_nodes_{kind}", functools.partial(_lamp_nodes, kind))


def _world(kind: str) -> None:
    scene = start()
    ball(plain((0.7, 0.7, 0.7)))
    world, tree = scene.world, scene.world.node_tree
    background = tree.nodes["Background"]
    if kind == "none":
        scene.world = None
    elif kind == "black":
        background.inputs["Strength"].default_value = 0.0
    elif kind == "unlinked":
        tree.links.clear()
    elif kind == "no_nodes":
        world.use_nodes = False
        world.color = (0.1, 0.5, 0.2)
    elif kind in {"SINGLE_SCATTERING", "MULTIPLE_SCATTERING", "PREETHAM", "HOSEK_WILKIE"}:
        node = tree.nodes.new("ShaderNodeTexSky")
        node.sky_type = kind
        tree.links.new(node.outputs[0], background.inputs["Color"])
        background.inputs["Strength"].default_value = 0.1
    elif kind in {"TexEnvironment", "TexImage", "TexNoise", "TexGradient", "TexChecker", "TexVoronoi"}:
        tree.links.new(tree.nodes.new(f"ShaderNode{kind}").outputs[0], background.inputs["Color"])
    elif kind == "volume":
        node = tree.nodes.new("ShaderNodeVolumeScatter")
        node.inputs["Density"].default_value = 0.05
        tree.links.new(node.outputs[0], tree.nodes["World Output"].inputs["Volume"])
    elif kind == "camera_only":
        world.cycles_visibility.diffuse = world.cycles_visibility.glossy = False
    elif kind == "behind_camera":
        world.cycles_visibility.camera = False
    elif kind == "color_on_the_output":
        node = tree.nodes.new("ShaderNodeRGB")
        tree.links.new(node.outputs[0], tree.nodes["World Output"].inputs["Surface"])
    elif kind == "light_path":
        tree.links.new(tree.nodes.new("ShaderNodeLightPath").outputs[0], background.inputs["Strength"])
    elif kind == "strong":
        background.inputs["Strength"].default_value = 100.0
    elif kind == "emission":
        tree.links.new(tree.nodes.new("ShaderNodeEmission").outputs[0], tree.nodes["World Output"].inputs["Surface"])


for kind in [
    "none",
    "black",
    "unlinked",
    "no_nodes",
    "SINGLE_SCATTERING",
    "MULTIPLE_SCATTERING",
    "PREETHAM",
    "HOSEK_WILKIE",
    "TexEnvironment",
    "TexImage",
    "TexNoise",
    "TexGradient",
    "TexChecker",
    "TexVoronoi",
    "volume",
    "camera_only",
    "behind_camera",
    "color_on_the_output",
    "light_path",
    "strong",
    "emission",
]:
    file(f"world_{kind.lower()}", functools.partial(_world, kind))


def _no_light() -> None:
    """An object that glows as the only light."""
    scene = start()
    bpy.data.objects.remove(bpy.data.objects["Light"])
    scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.0
    ball(plain((0.8, 0.8, 0.8), Emission_Strength=3.0, Emission_Color=(1.0, 0.6, 0.3, 1.0)))
    bpy.context.object.scale = (0.5, 0.5, 0.5)


file("light_by_an_object_alone", _no_light)
