# SPDX-License-Identifier: GPL-3.0-or-later
"""Shader nodes under light: each with its options, Principled socket by socket, mixes, and values that drive them."""

import bpy

from ...net import material, socket
from ...scenes import place, plane
from ..rows import lit, value
from ..values.coordinates import ATTRIBUTES, attribute_values
from ..values.image_textures import image, texture

LONG = {"camera_path_length": 64, "photon_path_length": 24}
"""Settings where light runs through glass: of white glass, roughness 0.2, in a white sky, 24 segments show 0.994, and
48 show 0.9975 as Cycles does."""


def shader(kind, inputs=None, **properties):
    return socket(kind, 0, inputs, **properties)


# --- shaders one by one -------------------------------------------------------------------------------

COLOR = {"Color": (0.8, 0.45, 0.3)}


def diffuse(**inputs):
    return shader("BsdfDiffuse", COLOR | inputs)


def glossy(roughness, anisotropy=None, distribution=None, **inputs):
    stretched = {} if anisotropy is None else {"Anisotropy": anisotropy}
    properties = {} if distribution is None else {"distribution": distribution}
    return shader("BsdfAnisotropic", COLOR | {"Roughness": roughness} | stretched | inputs, **properties)


_side = socket("CombineXYZ", inputs={0: 0.5, 1: 0.5, 2: 0.5})
lit("Diffuse", "smooth", diffuse())
lit("Diffuse", "roughness 0.8", diffuse(Roughness=0.8))
lit("Diffuse", "a normal of nodes, on the far side of half the ball", diffuse(Normal=_side))
for _roughness in (0.0, 0.25, 0.6):
    for _distribution in ("GGX", "MULTI_GGX") if _roughness else ("GGX",):
        _name, _effort = f"{_distribution}, roughness {_roughness}", 1 if _roughness else 3
        lit("Glossy", _name, glossy(_roughness, distribution=_distribution), effort=_effort)
for _distribution in ("BECKMANN", "ASHIKHMIN_SHIRLEY"):
    lit("Glossy", f"{_distribution}, roughness 0.3", glossy(0.3, distribution=_distribution))
lit("Glossy", "anisotropy 0.7, rotated", glossy(0.4, 0.7, Rotation=0.1), effort=2)
lit("Glossy", "anisotropy 0.8, roughness 0.8", glossy(0.8, 0.8))
for _roughness in (0.0, 0.2):
    _name, _glass = f"roughness {_roughness}", {"Color": (0.9, 0.95, 1.0), "Roughness": _roughness}
    lit("Glass", _name, shader("BsdfGlass", _glass), settings=LONG, effort=2)
    _clear = {"Roughness": _roughness, "IOR": 1.3}
    lit("Refraction", _name, shader("BsdfRefraction", _clear), settings=LONG, effort=3)
lit("Transparent", "tinted", shader("BsdfTransparent", {"Color": (0.8, 0.6, 0.4)}), effort=3)
lit("Translucent", "plain", shader("BsdfTranslucent", COLOR))
lit("Sheen", "MICROFIBER", shader("BsdfSheen", COLOR | {"Roughness": 0.4}))
lit("Sheen", "ASHIKHMIN", shader("BsdfSheen", COLOR | {"Roughness": 0.4}, distribution="ASHIKHMIN"))
lit("Emission", "plain", shader("Emission", COLOR | {"Strength": 2.0}), effort=3)
lit("Holdout", "plain", shader("Holdout"))
lit("Toon", "plain", shader("BsdfToon", COLOR))
lit("Toon", "smooth", shader("BsdfToon", COLOR | {"Size": 0.8, "Smooth": 0.6}))
lit("Toon", "glossy", shader("BsdfToon", COLOR | {"Size": 0.2, "Smooth": 0.2}, component="GLOSSY"))


def subsurface(scale, inputs=None, **properties):
    radii = COLOR | {"Radius": (1.0, 0.5, 0.2), "Scale": scale}
    return shader("SubsurfaceScattering", radii | (inputs or {}), **properties)


GROUP = "Subsurface Scattering"
SMOOTH = {"Anisotropy": 0.8, "Roughness": 0.0, "IOR": 1.6}
STANDS_IN = {"mean": 0.05, "block": 0.2, "warns": True, "reason": "a random walk of the same mean free path stands in"}
lit(GROUP, "small radius", shader("SubsurfaceScattering", {"Scale": 0.02}))
lit(GROUP, "RANDOM_WALK", subsurface(0.5), effort=2)
lit(GROUP, "anisotropy 0.8, smooth", subsurface(0.5, SMOOTH), effort=2)
lit(GROUP, "RANDOM_WALK_SKIN", subsurface(0.2, falloff="RANDOM_WALK_SKIN"), effort=2)
lit(GROUP, "BURLEY", subsurface(0.5, falloff="BURLEY"), effort=2, **STANDS_IN)

# --- Principled -----------------------------------------------------------------------------------------

BASE = {"Base Color": (0.75, 0.4, 0.25)}
PRINCIPLED = {
    "as it comes": {}, "roughness 0.2": {"Roughness": 0.2}, "roughness 1": {"Roughness": 1.0},
    "metallic": {"Metallic": 1.0, "Roughness": 0.3}, "half metallic": {"Metallic": 0.5},
    "IOR 2": {"IOR": 2.0, "Roughness": 0.3}, "IOR 1": {"IOR": 1.0}, "alpha 0.4": {"Alpha": 0.4},
    "diffuse roughness": {"Diffuse Roughness": 0.9}, "specular level 1": {"Specular IOR Level": 1.0},
    "specular level 0": {"Specular IOR Level": 0.0}, "specular tint": {"Specular Tint": (1.0, 0.5, 0.1)},
    "anisotropic": {"Metallic": 1.0, "Roughness": 0.4, "Anisotropic": 0.8},
    "anisotropic rotation": {"Metallic": 1.0, "Roughness": 0.4, "Anisotropic": 0.8, "Anisotropic Rotation": 0.2},
    "transmission": {"Transmission Weight": 1.0, "Roughness": 0.0},
    "transmission, rough": {"Transmission Weight": 1.0, "Roughness": 0.3},
    "transmission 0.5": {"Transmission Weight": 0.5, "Roughness": 0.2},
    "coat": {"Coat Weight": 1.0}, "coat, rough and tinted": {
        "Coat Weight": 0.8, "Coat Roughness": 0.3, "Coat IOR": 1.8, "Coat Tint": (0.6, 0.8, 1.0)},
    "sheen": {"Sheen Weight": 1.0}, "sheen, tinted": {
        "Sheen Weight": 0.7, "Sheen Roughness": 0.3, "Sheen Tint": (1.0, 0.4, 0.2)},
    "emission": {"Emission Color": (1.0, 0.7, 0.3), "Emission Strength": 0.8},
    "thin film": {"Thin Film Thickness": 400.0, "Metallic": 1.0, "Roughness": 0.2},
    "thin film, rough dielectric": {"Thin Film Thickness": 500.0, "Thin Film IOR": 1.8, "Roughness": 0.6},
    "subsurface": {"Subsurface Weight": 1.0, "Subsurface Scale": 0.02},
    "subsurface 0.6, skin": {"Subsurface Weight": 0.6, "Subsurface Scale": 0.2},
}  # fmt: skip
METHODS = {"subsurface 0.6, skin": {"subsurface_method": "RANDOM_WALK_SKIN"}}
for _name, _inputs in PRINCIPLED.items():
    _give = shader("BsdfPrincipled", BASE | _inputs, **METHODS.get(_name, {}))
    # The ball touches the ground, where what it emits is noisy.
    _members = {"effort": 3} if _name == "emission" else {}
    lit("Principled", _name, _give, **({"settings": LONG, "effort": 2} if "transmission" in _name else _members))
_rough = BASE | {"Metallic": 1.0, "Roughness": 0.8}
lit("Principled", "GGX, metallic, rough", shader("BsdfPrincipled", _rough, distribution="GGX"))

# --- driven by nodes -----------------------------------------------------------------------------------

NOISE = {"Scale": 3.0, "Detail": 1.0}
COLORS = socket("TexNoise", "Color", NOISE)
FACTOR = socket("MapRange", 0, {0: socket("TexNoise", "Fac", NOISE), 1: 0.35, 2: 0.65, 3: 0.1, 4: 0.9})
"""Noise from 0.1 to 0.9."""


def principled(**sockets):
    """A Principled surface with sockets fed by functions of the net."""
    return shader("BsdfPrincipled", BASE | {name.replace("_", " "): given for name, given in sockets.items()})


def driven(name, prepare=None, on_ground=False, effort=1, **sockets):
    lit("Driven", name, principled(**sockets), prepare, on_ground=on_ground, effort=effort)


def _image_with_alpha(net):
    node = net.node("TexImage", image=image("png"))
    return net.out("BsdfPrincipled", 0, {"Base Color": node.outputs[0], "Alpha": node.outputs[1]})


_checker = socket("TexChecker", 0, {"Scale": 3.0, "Color1": (0.8, 0.2, 0.1)})
_facing = socket("ValToRGB", 0, {0: socket("LayerWeight", "Facing")})
_bump = socket("Bump", 0, {"Height": FACTOR, "Distance": 0.08})
_mapped = socket("NormalMap", 0, {"Color": lambda net: net.scaled(COLORS(net), 0.6, 0.2), "Strength": 0.7})
_along_u, _vertex_colors = socket("Tangent", direction_type="UV_MAP"), socket("VertexColor", 0, layer_name="Values")
_colored = attribute_values("FLOAT_COLOR", "POINT", *ATTRIBUTES["FLOAT_COLOR"])
_gray = {"space": "Non-Color", "kind": "gray"}
driven("Base Color by an image", on_ground=True, Base_Color=texture(kind="opaque"))
driven("Base Color by noise", on_ground=True, Base_Color=COLORS)
driven("Base Color by a checker", Base_Color=_checker)
driven("Base Color by a ramp of Fresnel", Base_Color=_facing)
driven("Base Color by an attribute", _colored, Base_Color=_vertex_colors)
driven("Roughness by noise", Roughness=FACTOR)
driven("Roughness by an image", Roughness=texture(**_gray), Metallic=1.0)
driven("Metallic by an image", Metallic=texture(**_gray, interpolation="Closest"))
lit("Driven", "Alpha by an image", _image_with_alpha)
driven("Emission Strength by noise", effort=3, Emission_Color=(1.0, 0.5, 0.2), Emission_Strength=FACTOR)
driven("Normal by a bump", Normal=_bump)
driven("Normal by a normal map", Roughness=0.3, Normal=_mapped)
driven("Coat Normal by a bump", Coat_Weight=1.0, Coat_Normal=_bump)
driven("Tangent by a UV map", Metallic=1.0, Roughness=0.4, Anisotropic=0.8, Tangent=_along_u)


_STEEP = socket("Bump", 0, {"Height": FACTOR, "Distance": 0.3})


def uncorrected(name, shown, **members):
    def prepare() -> None:
        bpy.data.materials["Feature"].cycles.use_bump_map_correction = False

    lit("Bump Map Correction", f"off, {name}", shown, prepare, **members)


_LIT_BELOW = {"reason": "light from below the smooth surface counts where a bump turns to it", "block": 0.06}
uncorrected("diffuse", shader("BsdfDiffuse", {"Normal": _STEEP}), **_LIT_BELOW)
uncorrected("glossy", shader("BsdfAnisotropic", {"Roughness": 0.5, "Normal": _STEEP}), effort=3)


def mixed(first, second, factor=0.4):
    return shader("MixShader", {0: factor, 1: first, 2: second})


def added(first, second):
    return shader("AddShader", {0: first, 1: second})


DIFFUSE, GLOSSY = diffuse(), shader("BsdfAnisotropic", {"Roughness": 0.2})
CLEAR, GLOW = shader("BsdfTransparent"), shader("Emission", {"Strength": 0.5})
BLUE, BACK = shader("BsdfDiffuse", {"Color": (0.1, 0.3, 0.8)}), socket("NewGeometry", "Backfacing")
HOLES = {"settings": {"camera_path_length": 8, "photon_path_length": 8}, "effort": 3}
"""Members of rows in which light goes in and out by holes."""
_cut_out = {
    "by an image": texture("Alpha", interpolation="Closest"),
    "by a checker": socket("TexChecker", "Fac", {"Scale": 3.3}),
}
lit("Mix Shader", "diffuse and glossy", mixed(DIFFUSE, GLOSSY))
lit("Mix Shader", "by Fresnel", mixed(DIFFUSE, GLOSSY, socket("Fresnel")))
lit("Mix Shader", "by noise", mixed(DIFFUSE, GLOSSY, FACTOR))
for _name, _alpha in _cut_out.items():
    lit("Mix Shader", f"cut out {_name}", mixed(CLEAR, DIFFUSE, _alpha), **HOLES)
lit("Mix Shader", "nested", mixed(mixed(DIFFUSE, GLOSSY), GLOW, 0.3))
lit("Mix Shader", "one side empty", shader("MixShader", {0: 0.3, 1: DIFFUSE}))
lit("Add Shader", "diffuse and emission", added(DIFFUSE, GLOW))
_half = shader("BsdfDiffuse", {"Color": 0.4}), shader("BsdfAnisotropic", {"Color": 0.3})
lit("Add Shader", "diffuse and glossy", added(*_half))
lit("Mix Shader", "front and back", mixed(DIFFUSE, BLUE, BACK))

# --- Light Path ----------------------------------------------------------------------------------------

GROUP = "Light Path"
LIGHT_PATH = (
    "Is Camera Ray", "Is Shadow Ray", "Is Diffuse Ray", "Is Glossy Ray", "Is Singular Ray", "Is Reflection Ray",
    "Is Transmission Ray", "Ray Depth", "Transparent Depth",
)  # fmt: skip
for _output in LIGHT_PATH:
    _colors = {
        "Factor_Float": socket("LightPath", _output),
        "A_Color": (0.2, 0.3, 0.8),
        "B_Color": (0.8, 0.3, 0.1),
    }
    lit(
        GROUP,
        f"{_output}, mixing a color",
        shader("BsdfDiffuse", {"Color": socket("Mix", 2, _colors, data_type="RGBA")}),
    )


_near = socket("Math", 0, {0: socket("LightPath", "Ray Length"), 1: 0.2}, operation="MULTIPLY", use_clamp=True)
_colors = {"Factor_Float": _near, "A_Color": (0.2, 0.3, 0.8), "B_Color": (0.8, 0.3, 0.1)}
lit(
    GROUP,
    "Ray Length, mixing a color",
    shader("BsdfDiffuse", {"Color": socket("Mix", 2, _colors, data_type="RGBA")}),
    reason="photons measure it from where they come from",
    warns=True,
)


def _panes() -> None:
    surface, net = material("Pane")
    net.output(net.out("BsdfTransparent", inputs={"Color": 1.0}))
    for away in (-2.2, -3.0):
        plane(3.0, surface, place((0.2, away, 1.5), (65.0, 0.0, 0.0)))


def _bending_pane() -> None:
    _panes()
    surface, net = material("Bending Pane")
    net.output(net.out("BsdfRefraction", inputs={"Roughness": 0.0, "IOR": 1.05}))
    plane(3.0, surface, place((0.2, -3.8, 1.5), (65.0, 0.0, 0.0)))


_LENGTH, _DEPTH, _PASSED = (socket("LightPath", name) for name in ("Ray Length", "Ray Depth", "Transparent Depth"))
_shown = socket("CombineXYZ", inputs={0: _LENGTH, 1: _DEPTH, 2: _PASSED})
value(GROUP, "lengths and depths behind two panes", _shown, 0.2, prepare=_panes, settings={"camera_path_length": 4})
value(GROUP, "length behind two panes and one that bends rays", _LENGTH, 0.2, prepare=_bending_pane,
      settings={"camera_path_length": 5})  # fmt: skip
SHADOWS = {
    "mean": 0.15, "block": 1.0, "warns": True,
    "reason": "rays to lights do not ask materials: glass goes on to make shadows and caustics",
}  # fmt: skip
_glass = mixed(shader("BsdfGlass", {"Roughness": 0.0}), CLEAR, socket("LightPath", "Is Shadow Ray"))
lit(GROUP, "glass without shadows", _glass, settings=LONG, effort=2, **SHADOWS)
_seen = socket("Math", 0, {0: socket("LightPath", "Is Camera Ray"), 1: 2.0}, operation="MULTIPLY")
lit(GROUP, "glow for the camera only", lambda net: net.emission((1.0, 0.6, 0.2), _seen(net)))
