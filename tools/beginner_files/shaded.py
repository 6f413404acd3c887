# SPDX-License-Identifier: GPL-3.0-or-later
"""Each node of the shader editor with its defaults, on a ball, and what beginners link wrongly."""

import functools

import bpy

from .files import ball, file, plain, start

SHADERS = [
    "BsdfDiffuse",
    "BsdfAnisotropic",
    "BsdfGlass",
    "BsdfRefraction",
    "BsdfTranslucent",
    "BsdfTransparent",
    "BsdfMetallic",
    "BsdfSheen",
    "BsdfToon",
    "BsdfRayPortal",
    "BsdfHair",
    "BsdfHairPrincipled",
    "BsdfPrincipled",
    "SubsurfaceScattering",
    "Emission",
    "Holdout",
    "EeveeSpecular",
    "Background",
    "AddShader",
    "MixShader",
    "VolumePrincipled",
    "VolumeAbsorption",
    "VolumeScatter",
    "VolumeCoefficients",
]
TEXTURES = [
    "TexBrick",
    "TexChecker",
    "TexEnvironment",
    "TexGabor",
    "TexGradient",
    "TexIES",
    "TexImage",
    "TexMagic",
    "TexNoise",
    "TexSky",
    "TexVoronoi",
    "TexWave",
    "TexWhiteNoise",
]
INPUTS = [
    "AmbientOcclusion",
    "Attribute",
    "Bevel",
    "CameraData",
    "VertexColor",
    "HairInfo",
    "Fresnel",
    "NewGeometry",
    "LayerWeight",
    "LightPath",
    "ObjectInfo",
    "ParticleInfo",
    "PointInfo",
    "RGB",
    "Tangent",
    "TexCoord",
    "UVMap",
    "Value",
    "VolumeInfo",
    "Wireframe",
]
CONVERTERS = [
    "BrightContrast",
    "Gamma",
    "HueSaturation",
    "Invert",
    "LightFalloff",
    "RGBCurve",
    "Bump",
    "Displacement",
    "Mapping",
    "Normal",
    "NormalMap",
    "VectorCurve",
    "VectorDisplacement",
    "VectorRotate",
    "VectorTransform",
    "Blackbody",
    "Clamp",
    "CombineColor",
    "CombineXYZ",
    "FloatCurve",
    "MapRange",
    "Math",
    "Mix",
    "RGBToBW",
    "SeparateColor",
    "SeparateXYZ",
    "ShaderToRGB",
    "ValToRGB",
    "VectorMath",
    "Wavelength",
    "Squeeze",
    "RadialTiling",
]


def empty_material() -> tuple[bpy.types.NodeTree, bpy.types.Node]:
    """The tree of a new material on a ball, and its output."""
    material = plain((0.8, 0.8, 0.8))
    tree = material.node_tree
    tree.nodes.remove(tree.nodes["Principled BSDF"])
    ball(material)
    return tree, tree.nodes["Material Output"]


def _shader(kind: str, world: bool) -> None:
    scene = start()
    if world:
        tree = scene.world.node_tree
        tree.nodes.clear()
        output = tree.nodes.new("ShaderNodeOutputWorld")
        ball()
    else:
        tree, output = empty_material()
    node = tree.nodes.new(f"ShaderNode{kind}")
    socket = "Volume" if kind.startswith("Volume") else "Surface"
    tree.links.new(node.outputs[0], output.inputs[socket])


for kind in SHADERS:
    file(f"shader_{kind.lower()}", functools.partial(_shader, kind, False))


def _texture(kind: str, use: str) -> None:
    """A texture or value in a Base Color, straight on the output, or in a bump."""
    start()
    tree, output = empty_material()
    node = tree.nodes.new(f"ShaderNode{kind}")
    out = next((socket for socket in node.outputs if socket.enabled), None)
    if use == "surface":
        tree.links.new(out, output.inputs["Surface"])
        return
    principled = tree.nodes.new("ShaderNodeBsdfPrincipled")
    tree.links.new(principled.outputs[0], output.inputs["Surface"])
    if use == "bump":
        bump = tree.nodes.new("ShaderNodeBump")
        tree.links.new(out, bump.inputs["Height"])
        out = bump.outputs[0]
    socket = {"color": "Base Color", "bump": "Normal", "roughness": "Roughness"}[use]
    tree.links.new(out, principled.inputs[socket])


for kind in TEXTURES:
    for use in ("color", "bump", "surface", "roughness"):
        file(f"texture_{kind.lower()}_{use}", functools.partial(_texture, kind, use))
for kind in INPUTS:
    file(f"input_{kind.lower()}", functools.partial(_texture, kind, "color"))


def _converter(kind: str) -> None:
    """With noise in its first input, on the surface by emission; normals and displacements where they belong."""
    start()
    tree, output = empty_material()
    node, noise = tree.nodes.new(f"ShaderNode{kind}"), tree.nodes.new("ShaderNodeTexNoise")
    if kind == "ShaderToRGB":
        noise = tree.nodes.new("ShaderNodeBsdfDiffuse")
    given = [socket for socket in node.inputs if socket.enabled]
    named = {"Bump": "Height", "NormalMap": "Color", "Displacement": "Height"}.get(kind)
    if given:
        tree.links.new(noise.outputs[0], node.inputs[named] if named else given[-1])
    out = next(socket for socket in node.outputs if socket.enabled)
    principled = tree.nodes.new("ShaderNodeBsdfPrincipled")
    tree.links.new(principled.outputs[0], output.inputs["Surface"])
    if "Displacement" in kind:
        tree.links.new(out, output.inputs["Displacement"])
        return
    normal = kind in {"Bump", "NormalMap"}
    tree.links.new(out, principled.inputs["Normal" if normal else "Base Color"])


for kind in CONVERTERS:
    file(f"convert_{kind.lower()}", functools.partial(_converter, kind))


def _principled(values: dict[str, object]) -> None:
    start()
    ball(plain((0.8, 0.35, 0.1), **values))


for name, values in {
    "metal": {"Metallic": 1.0},
    "mirror": {"Metallic": 1.0, "Roughness": 0.0},
    "glass": {"Transmission_Weight": 1.0, "Roughness": 0.0},
    "rough_glass": {"Transmission_Weight": 1.0, "Roughness": 0.5},
    "ior_1": {"Transmission_Weight": 1.0, "Roughness": 0.0, "IOR": 1.0},
    "ior_below_1": {"Transmission_Weight": 1.0, "Roughness": 0.0, "IOR": 0.8},
    "ior_3": {"IOR": 3.0},
    "alpha_half": {"Alpha": 0.5},
    "alpha_0": {"Alpha": 0.0},
    "coat": {"Coat_Weight": 1.0},
    "sheen": {"Sheen_Weight": 1.0},
    "emission": {"Emission_Strength": 2.0, "Emission_Color": (1.0, 0.3, 0.1, 1.0)},
    "subsurface": {"Subsurface_Weight": 1.0},
    "specular_0": {"Specular_IOR_Level": 0.0},
    "specular_1": {"Specular_IOR_Level": 1.0},
    "roughness_0": {"Roughness": 0.0},
    "roughness_1": {"Roughness": 1.0},
    "anisotropic": {"Metallic": 1.0, "Anisotropic": 0.8, "Roughness": 0.3},
    "thin_film": {"Thin_Film_Thickness": 400.0, "Roughness": 0.1},
    "diffuse_roughness": {"Diffuse_Roughness": 1.0},
    "color_above_1": {"Base_Color": (1.5, 1.2, 0.9, 1.0)},
    "black": {"Base_Color": (0.0, 0.0, 0.0, 1.0)},
    "negative_color": {"Base_Color": (-0.5, 0.5, 0.5, 1.0)},
}.items():
    file(f"principled_{name}", functools.partial(_principled, values))


def _wrong(kind: str) -> None:
    start()
    tree, output = empty_material()
    if kind == "nothing_on_the_output":
        tree.nodes.new("ShaderNodeBsdfPrincipled")
    elif kind == "no_output":
        tree.nodes.remove(output)
    elif kind == "two_outputs":
        for name, shader in (("CYCLES", "Emission"), ("EEVEE", "BsdfDiffuse")):
            other = tree.nodes.new("ShaderNodeOutputMaterial")
            other.target = name
            tree.links.new(tree.nodes.new(f"ShaderNode{shader}").outputs[0], other.inputs["Surface"])
    elif kind == "surface_and_volume":
        for shader, socket in (("BsdfGlass", "Surface"), ("VolumeAbsorption", "Volume")):
            tree.links.new(tree.nodes.new(f"ShaderNode{shader}").outputs[0], output.inputs[socket])
    elif kind == "shader_in_displacement":
        tree.links.new(tree.nodes.new("ShaderNodeBsdfDiffuse").outputs[0], output.inputs["Surface"])
        tree.links.new(tree.nodes.new("ShaderNodeTexNoise").outputs["Color"], output.inputs["Displacement"])
    elif kind == "vector_as_surface":
        tree.links.new(tree.nodes.new("ShaderNodeNewGeometry").outputs["Normal"], output.inputs["Surface"])
    elif kind == "value_as_surface":
        tree.links.new(tree.nodes.new("ShaderNodeValue").outputs[0], output.inputs["Surface"])
    elif kind == "surface_as_volume":
        tree.links.new(tree.nodes.new("ShaderNodeBsdfDiffuse").outputs[0], output.inputs["Volume"])
    elif kind == "without_nodes":
        bpy.context.object.data.materials[0].use_nodes = False
        bpy.context.object.data.materials[0].diffuse_color = (0.1, 0.6, 0.2, 1.0)
    elif kind == "emission_strong":
        node = tree.nodes.new("ShaderNodeEmission")
        node.inputs["Strength"].default_value = 1000.0
        tree.links.new(node.outputs[0], output.inputs["Surface"])
    elif kind == "mixed_by_fresnel":
        mix = tree.nodes.new("ShaderNodeMixShader")
        tree.links.new(tree.nodes.new("ShaderNodeFresnel").outputs[0], mix.inputs[0])
        tree.links.new(tree.nodes.new("ShaderNodeBsdfDiffuse").outputs[0], mix.inputs[1])
        tree.links.new(tree.nodes.new("ShaderNodeBsdfAnisotropic").outputs[0], mix.inputs[2])
        tree.links.new(mix.outputs[0], output.inputs["Surface"])


for kind in [
    "nothing_on_the_output",
    "no_output",
    "two_outputs",
    "surface_and_volume",
    "shader_in_displacement",
    "vector_as_surface",
    "value_as_surface",
    "surface_as_volume",
    "without_nodes",
    "emission_strong",
    "mixed_by_fresnel",
]:
    file(f"material_{kind}", functools.partial(_wrong, kind))


def _material_setting(name: str, value: object) -> None:
    start()
    tree, output = empty_material()
    node = tree.nodes.new("ShaderNodeDisplacement")
    tree.links.new(tree.nodes.new("ShaderNodeTexNoise").outputs[0], node.inputs["Height"])
    tree.links.new(node.outputs[0], output.inputs["Displacement"])
    tree.links.new(tree.nodes.new("ShaderNodeBsdfPrincipled").outputs[0], output.inputs["Surface"])
    setattr(bpy.context.object.data.materials[0], name, value)


for name, value in (
    ("displacement_method", "DISPLACEMENT"),
    ("displacement_method", "BOTH"),
    ("use_backface_culling", True),
    ("use_transparent_shadow", False),
):
    file(f"material_{name}_{str(value).lower()}", functools.partial(_material_setting, name, value))
