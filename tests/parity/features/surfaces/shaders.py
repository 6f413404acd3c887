# SPDX-License-Identifier: GPL-3.0-or-later
"""Shader nodes under light: each with its options, Principled socket by socket, mixes, and values that drive them."""

from ...net import material
from ...scenes import place, plane
from ..rows import lit, value
from ..values.image_textures import image, texture

LONG = {"camera_path_length": 64, "photon_path_length": 24}
"""Settings where light runs through glass: of white glass, roughness 0.2, in a white sky, 24 segments show 0.994, and
48 show 0.9975 as Cycles does."""
NOISE = {"Scale": 3.0, "Detail": 1.0}


def shader(kind, inputs=None, **properties):
    return lambda net: net.out(kind, 0, inputs, **properties)


# --- shaders one by one -------------------------------------------------------------------------------

COLOR = {"Color": (0.8, 0.45, 0.3)}
lit("Diffuse", "smooth", shader("BsdfDiffuse", COLOR))
lit("Diffuse", "roughness 0.8", shader("BsdfDiffuse", COLOR | {"Roughness": 0.8}))
lit(
    "Diffuse",
    "a normal of nodes, on the far side of half the ball",
    lambda net: net.out("BsdfDiffuse", 0, COLOR | {"Normal": net.out("CombineXYZ", inputs={0: 0.5, 1: 0.5, 2: 0.5})}),
)
for _roughness in (0.0, 0.25, 0.6):
    for _distribution in ("GGX", "MULTI_GGX") if _roughness else ("GGX",):
        lit(
            "Glossy",
            f"{_distribution}, roughness {_roughness}",
            shader("BsdfAnisotropic", COLOR | {"Roughness": _roughness}, distribution=_distribution),
            effort=1 if _roughness else 3,
        )
lit(
    "Glossy",
    "BECKMANN, roughness 0.3",
    shader("BsdfAnisotropic", COLOR | {"Roughness": 0.3}, distribution="BECKMANN"),
)
lit(
    "Glossy",
    "ASHIKHMIN_SHIRLEY, roughness 0.3",
    shader("BsdfAnisotropic", COLOR | {"Roughness": 0.3}, distribution="ASHIKHMIN_SHIRLEY"),
)
lit(
    "Glossy",
    "anisotropy 0.7, rotated",
    shader("BsdfAnisotropic", COLOR | {"Roughness": 0.4, "Anisotropy": 0.7, "Rotation": 0.1}),
    effort=2,
)
lit(
    "Glossy",
    "anisotropy 0.8, roughness 0.8",
    shader("BsdfAnisotropic", COLOR | {"Roughness": 0.8, "Anisotropy": 0.8}),
)
for _roughness in (0.0, 0.2):
    lit(
        "Glass",
        f"roughness {_roughness}",
        shader("BsdfGlass", {"Color": (0.9, 0.95, 1.0), "Roughness": _roughness}),
        settings=LONG,
        effort=2,
    )
    lit(
        "Refraction",
        f"roughness {_roughness}",
        shader("BsdfRefraction", {"Roughness": _roughness, "IOR": 1.3}),
        settings=LONG,
        effort=3,
    )
lit("Transparent", "tinted", shader("BsdfTransparent", {"Color": (0.8, 0.6, 0.4)}), effort=3)
lit("Translucent", "plain", shader("BsdfTranslucent", COLOR))
lit("Sheen", "MICROFIBER", shader("BsdfSheen", COLOR | {"Roughness": 0.4}))
lit("Sheen", "ASHIKHMIN", shader("BsdfSheen", COLOR | {"Roughness": 0.4}, distribution="ASHIKHMIN"))
lit("Emission", "plain", shader("Emission", COLOR | {"Strength": 2.0}), effort=3)
lit("Holdout", "plain", shader("Holdout"))
lit("Toon", "plain", shader("BsdfToon", COLOR))
lit("Toon", "smooth", shader("BsdfToon", COLOR | {"Size": 0.8, "Smooth": 0.6}))
lit("Toon", "glossy", shader("BsdfToon", COLOR | {"Size": 0.2, "Smooth": 0.2}, component="GLOSSY"))
SUBSURFACE = COLOR | {"Radius": (1.0, 0.5, 0.2)}
lit("Subsurface Scattering", "small radius", shader("SubsurfaceScattering", {"Scale": 0.02}))
lit("Subsurface Scattering", "RANDOM_WALK", shader("SubsurfaceScattering", SUBSURFACE | {"Scale": 0.5}), effort=2)
lit(
    "Subsurface Scattering",
    "anisotropy 0.8, smooth",
    shader("SubsurfaceScattering", SUBSURFACE | {"Scale": 0.5, "Anisotropy": 0.8, "Roughness": 0.0, "IOR": 1.6}),
    effort=2,
)
lit(
    "Subsurface Scattering",
    "RANDOM_WALK_SKIN",
    shader("SubsurfaceScattering", SUBSURFACE | {"Scale": 0.2}, falloff="RANDOM_WALK_SKIN"),
    effort=2,
)
lit(
    "Subsurface Scattering",
    "BURLEY",
    shader("SubsurfaceScattering", SUBSURFACE | {"Scale": 0.5}, falloff="BURLEY"),
    effort=2,
    mean=0.05,
    block=0.2,
    warns=True,
    reason="a random walk of the same mean free path stands in",
)
lit(
    "Ray Portal",
    "plain",
    shader("BsdfRayPortal"),
    mean=0.8,
    block=8.0,
    warns=True,
    effort=2,
    reason="a diffuse surface stands in",
)

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
    "subsurface": {"Subsurface Weight": 1.0, "Subsurface Scale": 0.02},
    "subsurface 0.6, skin": {"Subsurface Weight": 0.6, "Subsurface Scale": 0.2},
}  # fmt: skip
# The ball touches the ground, where what it sends is noisy.
KNOWN = {
    "emission": {"effort": 3},
}
METHODS = {"subsurface 0.6, skin": {"subsurface_method": "RANDOM_WALK_SKIN"}}
for _name, _inputs in PRINCIPLED.items():
    lit(
        "Principled",
        _name,
        shader("BsdfPrincipled", BASE | _inputs, **METHODS.get(_name, {})),
        **({"settings": LONG, "effort": 2} if "transmission" in _name else KNOWN.get(_name, {})),
    )
lit(
    "Principled",
    "GGX, metallic, rough",
    shader("BsdfPrincipled", BASE | {"Metallic": 1.0, "Roughness": 0.8}, distribution="GGX"),
)

# --- driven by nodes -----------------------------------------------------------------------------------


def _noise(net, output="Fac", low=0.1, high=0.9):
    return net.out("MapRange", 0, {0: net.out("TexNoise", output, NOISE), 1: 0.35, 2: 0.65, 3: low, 4: high})


def principled(**sockets):
    """A Principled surface with sockets fed by functions of the net."""

    def give(net):
        fed = {name.replace("_", " "): make(net) if callable(make) else make for name, make in sockets.items()}
        return net.out("BsdfPrincipled", 0, BASE | fed)

    return give


def color_noise(net):
    return net.out("TexNoise", "Color", NOISE)


lit("Driven", "Base Color by an image", principled(Base_Color=texture(kind="opaque")), on_ground=True)
lit("Driven", "Base Color by noise", principled(Base_Color=color_noise), on_ground=True)
lit(
    "Driven",
    "Base Color by a checker",
    principled(Base_Color=lambda net: net.out("TexChecker", 0, {"Scale": 3.0, "Color1": (0.8, 0.2, 0.1)})),
)
lit(
    "Driven",
    "Base Color by a ramp of Fresnel",
    principled(Base_Color=lambda net: net.out("ValToRGB", 0, {0: net.out("LayerWeight", "Facing")})),
)
lit(
    "Driven",
    "Base Color by an attribute",
    principled(Base_Color=lambda net: net.out("VertexColor", 0, layer_name="Values")),
    prepare=lambda: _colors(),
)
lit("Driven", "Roughness by noise", principled(Roughness=_noise))
lit("Driven", "Roughness by an image", principled(Roughness=texture(space="Non-Color", kind="gray"), Metallic=1.0))
lit(
    "Driven",
    "Metallic by an image",
    principled(Metallic=texture(space="Non-Color", kind="gray", interpolation="Closest")),
)
lit(
    "Driven",
    "Alpha by an image",
    lambda net: net.out(
        "BsdfPrincipled",
        0,
        {"Base Color": (node := net.node("TexImage", image=image("png"))).outputs[0], "Alpha": node.outputs[1]},
    ),
)
lit(
    "Driven",
    "Emission Strength by noise",
    principled(Emission_Color=(1.0, 0.5, 0.2), Emission_Strength=_noise),
    effort=3,
)
lit(
    "Driven",
    "Normal by a bump",
    principled(Normal=lambda net: net.out("Bump", 0, {"Height": _noise(net), "Distance": 0.08})),
)
lit(
    "Driven",
    "Normal by a normal map",
    principled(
        Roughness=0.3,
        Normal=lambda net: net.out("NormalMap", 0, {"Color": net.scaled(color_noise(net), 0.6, 0.2), "Strength": 0.7}),
    ),
)
lit(
    "Driven",
    "Coat Normal by a bump",
    principled(Coat_Weight=1.0, Coat_Normal=lambda net: net.out("Bump", 0, {"Height": _noise(net), "Distance": 0.08})),
)
lit(
    "Driven",
    "Tangent by a UV map",
    principled(
        Metallic=1.0, Roughness=0.4, Anisotropic=0.8, Tangent=lambda net: net.out("Tangent", direction_type="UV_MAP")
    ),
)


def _colors():
    from ..values.coordinates import ATTRIBUTES, attribute_values

    attribute_values("FLOAT_COLOR", "POINT", *ATTRIBUTES["FLOAT_COLOR"])()


def mixed(first, second, factor=0.4):
    def give(net):
        fed = factor(net) if callable(factor) else factor
        return net.out("MixShader", 0, {0: fed, 1: first(net), 2: second(net)})

    return give


def added(first, second):
    return lambda net: net.out("AddShader", 0, {0: first(net), 1: second(net)})


DIFFUSE, GLOSSY = shader("BsdfDiffuse", COLOR), shader("BsdfAnisotropic", {"Roughness": 0.2})
CLEAR, GLOW = shader("BsdfTransparent"), shader("Emission", {"Strength": 0.5})
lit("Mix Shader", "diffuse and glossy", mixed(DIFFUSE, GLOSSY))
lit("Mix Shader", "by Fresnel", mixed(DIFFUSE, GLOSSY, lambda net: net.out("Fresnel")))
lit("Mix Shader", "by noise", mixed(DIFFUSE, GLOSSY, _noise))
HOLES = {"camera_path_length": 8, "photon_path_length": 8}
"""Light goes in and out by them."""
lit(
    "Mix Shader",
    "cut out by an image",
    mixed(CLEAR, DIFFUSE, texture("Alpha", interpolation="Closest")),
    settings=HOLES,
    effort=3,
)
lit(
    "Mix Shader",
    "cut out by a checker",
    mixed(CLEAR, DIFFUSE, lambda net: net.out("TexChecker", "Fac", {"Scale": 3.3})),
    settings=HOLES,
    effort=3,
)
lit("Mix Shader", "nested", mixed(mixed(DIFFUSE, GLOSSY), GLOW, 0.3))
lit("Mix Shader", "one side empty", lambda net: net.out("MixShader", 0, {0: 0.3, 1: DIFFUSE(net)}))
lit("Add Shader", "diffuse and emission", added(DIFFUSE, GLOW))
lit(
    "Add Shader",
    "diffuse and glossy",
    added(shader("BsdfDiffuse", {"Color": 0.4}), shader("BsdfAnisotropic", {"Color": 0.3})),
)
lit(
    "Mix Shader",
    "front and back",
    mixed(DIFFUSE, shader("BsdfDiffuse", {"Color": (0.1, 0.3, 0.8)}), lambda net: net.out("NewGeometry", "Backfacing")),
)

LIGHT_PATH = (
    "Is Camera Ray",
    "Is Shadow Ray",
    "Is Diffuse Ray",
    "Is Glossy Ray",
    "Is Singular Ray",
    "Is Reflection Ray",
    "Is Transmission Ray",
    "Ray Depth",
    "Transparent Depth",
)
for _output in LIGHT_PATH:
    lit(
        "Light Path",
        f"{_output}, mixing a color",
        (
            lambda output: (
                lambda net: net.out(
                    "BsdfDiffuse",
                    0,
                    {
                        "Color": net.out(
                            "Mix",
                            2,
                            {
                                "Factor_Float": net.out("LightPath", output),
                                "A_Color": (0.2, 0.3, 0.8),
                                "B_Color": (0.8, 0.3, 0.1),
                            },
                            data_type="RGBA",
                        )
                    },
                )
            )
        )(_output),
    )


def _panes() -> None:
    surface, net = material("Pane")
    net.output(net.out("BsdfTransparent", inputs={"Color": 1.0}))
    for away in (-2.2, -3.0):
        plane(3.0, surface, place((0.2, away, 1.5), (65.0, 0.0, 0.0)))


value(
    "Light Path",
    "lengths and depths behind two panes",
    lambda net: net.out(
        "CombineXYZ",
        inputs={
            0: net.out("LightPath", "Ray Length"),
            1: net.out("LightPath", "Ray Depth"),
            2: net.out("LightPath", "Transparent Depth"),
        },
    ),
    0.2,
    prepare=_panes,
    settings={"camera_path_length": 4},
)


def _bending_pane() -> None:
    _panes()
    surface, net = material("Bending Pane")
    net.output(net.out("BsdfRefraction", inputs={"Roughness": 0.0, "IOR": 1.05}))
    plane(3.0, surface, place((0.2, -3.8, 1.5), (65.0, 0.0, 0.0)))


value(
    "Light Path",
    "length behind two panes and one that bends rays",
    lambda net: net.out("LightPath", "Ray Length"),
    0.2,
    prepare=_bending_pane,
    settings={"camera_path_length": 5},
)
lit(
    "Light Path",
    "glass without shadows",
    mixed(shader("BsdfGlass", {"Roughness": 0.0}), CLEAR, lambda net: net.out("LightPath", "Is Shadow Ray")),
    settings=LONG,
    effort=2,
    mean=0.15,
    block=1.0,
    reason="rays to lights do not ask materials: glass goes on to make shadows and caustics",
)
lit(
    "Light Path",
    "glow for the camera only",
    lambda net: net.emission(
        (1.0, 0.6, 0.2), net.out("Math", 0, {0: net.out("LightPath", "Is Camera Ray"), 1: 2.0}, operation="MULTIPLY")
    ),
)
