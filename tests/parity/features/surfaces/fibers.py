# SPDX-License-Identifier: GPL-3.0-or-later
"""Shaders of fibers, on a mesh and on strands."""

from ...net import material
from .. import stage
from ..rows import Kind, Row, add, lit
from ..shapes.strands import OUTLINES, stand, thick_tuft

GROUPS = "Hair", "Principled Hair"
LONG = {"camera_path_length": 64, "photon_path_length": 24}
"""Light runs through what is shaded so as through glass."""
COLOR = {"Color": (0.6, 0.3, 0.15)}
_TWO_GUESSES = {"block": 0.1, "reason": "what is reflected within is guessed in two ways, toward lights and by paths"}


def shader(kind, inputs, **properties):
    return lambda net: net.out(kind, 0, inputs, **properties)


for _component in ("Reflection", "Transmission"):
    _inputs = COLOR | {"RoughnessV": 0.4}
    # Of fewer photons the noise is as large as what is compared.
    _settings = LONG | {"photons": 8192}
    lit("Hair", _component, shader("BsdfHair", _inputs, component=_component), settings=_settings, effort=2)
for _model in ("CHIANG", "HUANG"):
    lit(
        "Principled Hair",
        f"{_model}, a color",
        shader("BsdfHairPrincipled", COLOR, model=_model),
        settings=LONG,
        effort=2,
        **(_TWO_GUESSES if _model == "HUANG" else {}),
    )
lit(
    "Principled Hair",
    "CHIANG, melanin",
    shader("BsdfHairPrincipled", {"Melanin": 0.6, "Offset": 0.1}, parametrization="MELANIN"),
    settings=LONG,
    effort=2,
)
lit(
    "Principled Hair",
    "CHIANG, absorption, random, coated",
    shader(
        "BsdfHairPrincipled",
        {
            "Absorption Coefficient": (0.5, 0.9, 1.5),
            "Random": 0.8,
            "Random Roughness": 0.5,
            "Radial Roughness": 0.6,
            "Coat": 0.4,
        },
        parametrization="ABSORPTION",
    ),
    settings=LONG,
)


def on_strands(group, name, give, **members):
    """A row of strands that stand on the ground."""

    def build():
        stage.empty()
        surface, net = material()
        net.output(give(net))
        stand(surface, thick_tuft)

    settings = {"camera_path_length": 24, "photon_path_length": 12}
    add(Row(group, f"{name}, on strands", build, Kind.LIGHT, OUTLINES, 0.01, 0.06, settings, 2, **members))


on_strands("Hair", "Reflection", shader("BsdfHair", COLOR | {"Offset": 0.2}, component="Reflection"))
on_strands("Hair", "Transmission", shader("BsdfHair", COLOR, component="Transmission"))
on_strands("Principled Hair", "CHIANG", shader("BsdfHairPrincipled", COLOR))
on_strands(
    "Principled Hair",
    "CHIANG, random",
    shader(
        "BsdfHairPrincipled",
        {"Melanin": 0.5, "Random Color": 1.0, "Random Roughness": 0.8},
        parametrization="MELANIN",
    ),
)
on_strands("Principled Hair", "HUANG", shader("BsdfHairPrincipled", COLOR, model="HUANG"))
