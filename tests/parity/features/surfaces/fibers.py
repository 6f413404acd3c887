# SPDX-License-Identifier: GPL-3.0-or-later
"""Shaders of fibers, on a mesh and on strands."""

from ...net import material, socket
from .. import stage
from ..rows import Kind, Row, add, lit
from ..shapes.strands import OUTLINES, stand, thick_tuft

GROUPS = "Hair", "Principled Hair"
LONG = {"camera_path_length": 64, "photon_path_length": 24}
"""Light runs through what is shaded so as through glass."""
COLOR = {"Color": (0.6, 0.3, 0.15)}
_TWO_GUESSES = {"block": 0.1, "reason": "what is reflected within is guessed in two ways, toward lights and by paths"}


def hair(inputs, **properties):
    return socket("BsdfHair", 0, COLOR | inputs, **properties)


def principled(inputs, **properties):
    return socket("BsdfHairPrincipled", 0, inputs, **properties)


for _component in ("Reflection", "Transmission"):
    # Of fewer photons the noise is as large as what is compared.
    _members = {"settings": LONG | {"photons": 8192}, "effort": 2}
    lit("Hair", _component, hair({"RoughnessV": 0.4}, component=_component), **_members)
for _model, _guesses in (("CHIANG", {}), ("HUANG", _TWO_GUESSES)):
    _give = principled(COLOR, model=_model)
    lit("Principled Hair", f"{_model}, a color", _give, settings=LONG, effort=2, **_guesses)
_melanin = principled({"Melanin": 0.6, "Offset": 0.1}, parametrization="MELANIN")
lit("Principled Hair", "CHIANG, melanin", _melanin, settings=LONG, effort=2)
_coated = {
    "Absorption Coefficient": (0.5, 0.9, 1.5), "Random": 0.8, "Random Roughness": 0.5, "Radial Roughness": 0.6,
    "Coat": 0.4,
}  # fmt: skip
_absorbing = principled(_coated, parametrization="ABSORPTION")
lit("Principled Hair", "CHIANG, absorption, random, coated", _absorbing, settings=LONG)


def on_strands(group, name, give, **members):
    """A row of strands that stand on the ground."""

    def build():
        stage.empty()
        surface, net = material()
        net.output(give(net))
        stand(surface, thick_tuft)

    settings = {"camera_path_length": 24, "photon_path_length": 12}
    add(Row(group, f"{name}, on strands", build, Kind.LIGHT, OUTLINES, 0.01, 0.06, settings, 2, **members))


_random = {"Melanin": 0.5, "Random Color": 1.0, "Random Roughness": 0.8}
on_strands("Hair", "Reflection", hair({"Offset": 0.2}, component="Reflection"))
on_strands("Hair", "Transmission", hair({}, component="Transmission"))
on_strands("Principled Hair", "CHIANG", principled(COLOR))
on_strands("Principled Hair", "CHIANG, random", principled(_random, parametrization="MELANIN"))
on_strands("Principled Hair", "HUANG", principled(COLOR, model="HUANG"))
