# SPDX-License-Identifier: GPL-3.0-or-later
"""Random materials: of one Principled BSDF, of images, of chained textures, and of mixed shaders."""

from collections.abc import Sequence
from typing import Any

import bpy

from . import images
from .draws import Draws
from .graphs import Graph, finish, material

COORDINATES = ("Generated", "UV", "Object", "Camera", "Window", "Normal", "Reflection")
METALS = ((0.95, 0.64, 0.54, 1.0), (1.0, 0.77, 0.34, 1.0), (0.6, 0.6, 0.62, 1.0), (0.9, 0.9, 0.88, 1.0))


def principled(name: str, color: Sequence[float], **inputs: Any) -> bpy.types.Material:
    """A material of a Principled BSDF; inputs by name with _ for a space."""
    made, graph = material(name)
    finish(graph, graph.node("BsdfPrincipled", Base_Color=tuple(color), **inputs))
    return made


def plain(draws: Draws) -> bpy.types.Material:
    """A color that is matte, satin or glossy."""
    return principled("Plain", draws.color(), Roughness=draws.between(0.25, 0.9))


def metal(draws: Draws) -> bpy.types.Material:
    """A rough or polished metal, perhaps brushed."""
    inputs = {"Metallic": 1.0, "Roughness": draws.between(0.1, 0.5)}
    if draws.maybe(0.3):
        inputs.update(Anisotropic=draws.between(0.3, 0.9), Anisotropic_Rotation=draws.random())
    return principled("Metal", draws.pick(METALS), **inputs)


def glass(draws: Draws, roughness: float | None = None) -> bpy.types.Material:
    """Clear or frosted glass, tinted a little, by one of the two nodes that people use."""
    color = draws.color(0.2, (0.85, 1.0))
    rough = draws.pick((0.0, 0.0, 0.1, 0.3)) if roughness is None else roughness
    if draws.maybe():
        return principled("Glass", color, Transmission_Weight=1.0, Roughness=rough, IOR=draws.between(1.3, 1.6))
    made, graph = material("Glass")
    finish(graph, graph.node("BsdfGlass", Color=color, Roughness=rough, IOR=draws.between(1.3, 1.6)))
    return made


def pane(draws: Draws) -> bpy.types.Material:
    """Window glass that lets shadow rays pass, of the Light Path node."""
    made, graph = material("Pane")
    path = graph.node("LightPath")
    passes = graph.math("MAXIMUM", path.outputs["Is Shadow Ray"], path.outputs["Is Diffuse Ray"])
    clear = graph.node("BsdfTransparent", Color=draws.color(0.1, (0.9, 1.0)))
    mirror = graph.node("BsdfAnisotropic", Roughness=0.0, Color=(1, 1, 1, 1))
    seen = graph.node("MixShader", None, {0: graph.node("Fresnel", IOR=1.45), 1: clear, 2: mirror})
    finish(graph, graph.node("MixShader", None, {0: passes, 1: seen, 2: clear}))
    return made


def skin(draws: Draws) -> bpy.types.Material:
    """Wax, skin or frosting with subsurface scattering."""
    method = draws.pick(("RANDOM_WALK", "RANDOM_WALK", "RANDOM_WALK_SKIN"))
    made, graph = material("Skin")
    shader = graph.node("BsdfPrincipled", {"subsurface_method": method}, Base_Color=draws.color(0.5, (0.5, 0.9)))
    for name, value in {
        "Subsurface Weight": draws.between(0.3, 1.0),
        "Subsurface Scale": draws.between(0.02, 0.2),
        "Roughness": draws.between(0.3, 0.6),
    }.items():
        shader.inputs[name].default_value = value
    finish(graph, shader)
    return made


def lacquer(draws: Draws) -> bpy.types.Material:
    """A Principled BSDF with some of its layers at random."""
    inputs: dict[str, Any] = {"Roughness": draws.between(0.2, 0.7), "Metallic": draws.pick((0.0, 0.0, 0.5, 1.0))}
    layers: list[dict[str, Any]] = [
        {"Coat_Weight": draws.between(0.3, 1.0), "Coat_Roughness": draws.between(0.03, 0.3), "Coat_IOR": 1.5},
        {"Coat_Weight": 1.0, "Coat_Tint": draws.color(0.7, (0.6, 1.0)), "Coat_Roughness": 0.1},
        {"Sheen_Weight": draws.between(0.2, 1.0), "Sheen_Roughness": 0.4, "Sheen_Tint": draws.color()},
        {"Transmission_Weight": draws.between(0.2, 0.8)},
        {"Subsurface_Weight": draws.between(0.2, 0.8), "Subsurface_Scale": 0.1},
        {"Specular_Tint": draws.color(0.8), "Specular_IOR_Level": draws.between(0.2, 1.0)},
        {"Emission_Color": draws.color(0.8), "Emission_Strength": draws.between(0.1, 1.0)},
        {"Thin_Film_Thickness": draws.between(200.0, 700.0)},
        {"Anisotropic": draws.between(0.3, 0.8)},
        {"Diffuse_Roughness": draws.between(0.3, 1.0)},
        {"Alpha": draws.between(0.4, 0.9)},
    ]
    for layer in draws.sample(layers, draws.randint(1, 3)):
        inputs.update(layer)
    return principled("Lacquer", draws.color(), **inputs)


def glow(draws: Draws, strength: float) -> bpy.types.Material:
    """An emission of a color or of a temperature."""
    made, graph = material("Glow")
    color = graph.node("Blackbody", Temperature=draws.between(2500.0, 9000.0)) if draws.maybe() else draws.color(0.8)
    finish(graph, graph.node("Emission", Color=color, Strength=strength))
    return made


def textured(draws: Draws, repeats: float | None = None) -> bpy.types.Material:
    """Images for color, roughness and normals, as libraries of textures have them, over UVs with a Mapping node."""
    made, graph = material("Textured")
    pattern = images.heights(draws)
    scale = draws.between(1.0, 4.0) if repeats is None else repeats
    turn = draws.pick((0.0, 0.0, 0.6))
    uv = graph.node("TexCoord").outputs["UV"]
    vector = graph.node("Mapping", Vector=uv, Scale=(scale, scale, scale), Rotation=(0.0, 0.0, turn))
    projected = {"projection": "BOX", "projection_blend": 0.3} if draws.maybe(0.2) else {}

    def picture(name: str, pixels: Any, data: bool = True) -> bpy.types.Node:
        return graph.node("TexImage", {"image": images.image(name, pixels, data), **projected}, Vector=vector)

    color = picture("Color", images.colored(draws), data=False).outputs[0]
    if draws.maybe(0.4):
        color = graph.mixed(
            draws.between(0.3, 1.0), color, picture("Dirt", images.gray(images.heights(draws))), "MULTIPLY"
        )
    inputs: dict[str, Any] = {"Roughness": picture("Roughness", images.gray(pattern, 0.25, 0.8))}
    choice = draws.pick(("normal", "bump", "both", "none"))
    if choice in {"normal", "both"}:
        colors = picture("Normals", images.normal_map(pattern))
        inputs["Normal"] = graph.node("NormalMap", Color=colors, Strength=draws.between(0.3, 1.0))
    if choice in {"bump", "both"}:
        inputs["Normal"] = graph.node(
            "Bump",
            Height=picture("Height", images.gray(pattern)),
            Strength=draws.between(0.1, 0.5),
            Distance=0.05,
            **({"Normal": inputs["Normal"]} if "Normal" in inputs else {}),
        )
    finish(graph, graph.node("BsdfPrincipled", Base_Color=color, **inputs))
    return made


def _pattern(draws: Draws, graph: Graph, vector: Any) -> Any:
    """A texture at random; its socket of numbers."""
    kind = draws.pick(("Noise", "Voronoi", "Brick", "Wave", "Magic", "Checker", "Gradient", "Gabor", "WhiteNoise"))
    scale = draws.between(1.5, 6.0)
    if kind == "Noise":
        shape = draws.pick(("FBM", "MULTIFRACTAL", "RIDGED_MULTIFRACTAL", "HETERO_TERRAIN", "HYBRID_MULTIFRACTAL"))
        settings = {"noise_type": shape, "noise_dimensions": draws.pick(("2D", "3D", "4D"))}
        made = graph.node("TexNoise", settings, Vector=vector, Scale=scale, Detail=draws.between(0.0, 5.0))
        made.inputs["Distortion"].default_value = draws.pick((0.0, 0.0, 1.0))
        return graph.node("MapRange", Value=made, From_Min=0.2, From_Max=0.9).outputs[0]
    if kind == "Voronoi":
        settings = {
            "feature": draws.pick(("F1", "F2", "SMOOTH_F1", "DISTANCE_TO_EDGE")),
            "distance": draws.pick(("EUCLIDEAN", "MANHATTAN", "CHEBYCHEV")),
        }
        return graph.node("TexVoronoi", settings, Vector=vector, Scale=scale).outputs["Distance"]
    if kind == "WhiteNoise":
        snapped = graph.node("VectorMath", {"operation": "SNAP"}, {0: vector, 1: (0.21, 0.23, 0.27)})
        return graph.node("TexWhiteNoise", None, {0: snapped}).outputs[0]
    output = {"Brick": "Factor", "Wave": "Factor", "Magic": "Factor", "Checker": "Factor", "Gradient": "Factor",
              "Gabor": "Value"}[kind]  # fmt: skip
    made = graph.node(f"Tex{kind}", None, Vector=vector)
    if kind != "Gradient":
        made.inputs["Scale"].default_value = scale
    return made.outputs.get(output) or made.outputs.get("Fac")


def coordinates(draws: Draws, graph: Graph) -> Any:
    """Texture coordinates of some kind through a Mapping node; sometimes distorted by noise."""
    vector = graph.node(
        "Mapping",
        Vector=graph.node("TexCoord").outputs[draws.pick(COORDINATES)],
        Location=draws.vector(-1.0, 1.0),
        Rotation=draws.vector(0.0, 1.5),
        Scale=draws.vector(0.7, 1.6),
    ).outputs[0]
    if draws.maybe(0.3):
        noise = graph.node("TexNoise", Vector=vector, Scale=2.0).outputs["Color"]
        vector = graph.mixed(draws.between(0.05, 0.3), vector, noise, draws.pick(("MIX", "LINEAR_LIGHT")))
    return vector


def _color(draws: Draws, graph: Graph, factor: Any) -> Any:
    stops = sorted((draws.random(), draws.color(0.8, (0.1, 0.9))) for _ in range(draws.randint(2, 5)))
    return graph.ramp(
        factor, stops, draws.pick(("LINEAR", "LINEAR", "EASE", "CONSTANT", "B_SPLINE", "CARDINAL"))
    ).outputs[0]


def layered_color(draws: Draws, graph: Graph) -> tuple[Any, Any]:
    """A color of chained textures, and the pattern that it is made of."""
    vector = coordinates(draws, graph)
    pattern = _pattern(draws, graph, vector)
    color = _color(draws, graph, pattern)
    for _ in range(draws.randint(0, 2)):
        second = _pattern(draws, graph, coordinates(draws, graph) if draws.maybe() else vector)
        blend = draws.pick(("MIX", "MULTIPLY", "OVERLAY", "SCREEN", "SOFT_LIGHT", "DARKEN", "HUE", "COLOR"))
        color = graph.mixed(second, color, _color(draws, graph, second), blend)
    if draws.maybe(0.3):
        color = graph.node("HueSaturation", Color=color, Hue=draws.random(), Saturation=draws.between(0.5, 1.2))
    return color, pattern


def procedural(draws: Draws) -> bpy.types.Material:
    """Chained textures for color, roughness and bump of one shader."""
    made, graph = material("Procedural")
    color, pattern = layered_color(draws, graph)
    inputs: dict[str, Any] = {"Roughness": graph.node("MapRange", Value=pattern, To_Min=0.3, To_Max=0.8).outputs[0]}
    if draws.maybe(0.6):
        inputs["Normal"] = graph.node("Bump", Height=pattern, Strength=draws.between(0.1, 0.5), Distance=0.1)
    if draws.maybe(0.3):
        inputs["Metallic"] = graph.math("GREATER_THAN", pattern, 0.5)
    finish(graph, graph.node("BsdfPrincipled", Base_Color=color, **inputs))
    return made


def _factor(draws: Draws, graph: Graph) -> Any:
    kind = draws.pick(("fresnel", "facing", "pattern", "layer", "backfacing", "random", "path"))
    if kind == "fresnel":
        return graph.node("Fresnel", IOR=draws.between(1.2, 2.0))
    if kind in {"facing", "layer"}:
        return graph.node("LayerWeight", Blend=draws.between(0.2, 0.8)).outputs[
            "Facing" if kind == "facing" else "Fresnel"
        ]
    if kind == "backfacing":
        return graph.node("NewGeometry").outputs["Backfacing"]
    if kind == "random":
        return graph.node("ObjectInfo").outputs["Random"]
    if kind == "path":
        return graph.node("LightPath").outputs[draws.pick(("Is Camera Ray", "Is Diffuse Ray", "Is Glossy Ray"))]
    return graph.math("GREATER_THAN", _pattern(draws, graph, coordinates(draws, graph)), 0.5)


def _shader(draws: Draws, graph: Graph) -> Any:
    color = layered_color(draws, graph)[0] if draws.maybe() else draws.color()
    usual = ("Diffuse", "Anisotropic", "Translucent", "Transparent", "Sheen", "Toon", "Metallic", "Principled")
    kind = draws.pick((*usual, "Glass", "Refraction", "Emission"))
    if kind == "Emission":
        return graph.node("Emission", Color=color, Strength=draws.between(0.2, 1.5))
    if kind == "Principled":
        return graph.node("BsdfPrincipled", Base_Color=color, Roughness=draws.between(0.3, 0.8))
    if kind == "Metallic":
        return graph.node("BsdfMetallic", Base_Color=color, Roughness=draws.between(0.2, 0.6))
    made = graph.node(f"Bsdf{kind}", Color=color)
    if "Roughness" in made.inputs and kind != "Diffuse":
        made.inputs["Roughness"].default_value = draws.between(0.2, 0.6)
    return made


def mixed(draws: Draws) -> bpy.types.Material:
    """Two to four shaders, mixed by the ways in which light falls on them."""
    made, graph = material("Mixed")
    shader = _shader(draws, graph)
    for _ in range(draws.randint(1, 3)):
        if draws.maybe(0.15):
            shader = graph.node("AddShader", None, {0: shader, 1: graph.node("Emission", Strength=0.1)})
        else:
            shader = graph.node("MixShader", None, {0: _factor(draws, graph), 1: shader, 2: _shader(draws, graph)})
    finish(graph, shader)
    return made


def leaf(draws: Draws) -> bpy.types.Material:
    """A card with the image of a leaf, cut out by its alpha."""
    made, graph = material("Leaf")
    picture = graph.node("TexImage", {"image": images.image("Leaf", images.leaf(draws))})
    if draws.maybe():
        finish(graph, graph.node("BsdfPrincipled", Base_Color=picture, Alpha=picture.outputs[1], Roughness=0.6))
        return made
    lit = graph.node(
        "MixShader",
        None,
        {0: 0.4, 1: graph.node("BsdfDiffuse", Color=picture), 2: graph.node("BsdfTranslucent", Color=picture)},
    )
    clear = graph.node("BsdfTransparent")
    finish(graph, graph.node("MixShader", None, {0: picture.outputs[1], 1: clear, 2: lit}))
    return made


def anything(draws: Draws) -> bpy.types.Material:
    """A material of any kind, the usual ones more often."""
    return draws.pick((plain, plain, metal, lacquer, lacquer, textured, textured, procedural, mixed, glass, skin))(
        draws
    )
