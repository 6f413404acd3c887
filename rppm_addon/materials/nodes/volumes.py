# SPDX-License-Identifier: GPL-3.0-or-later
"""Shader nodes of volumes.

A medium is evaluated part by part (materials/traits/interiors.py): the coefficient of a part, 1/m, or the radiance that
it emits by length, W/(m^3 sr), takes the place of the emission. The option "coefficient" selects the part of nodes that
have several. The color, density and temperature of grids multiply what the sockets of Principled Volume say.
"""

from ...gl.buffers.constants import Constants
from .node_kinds import COLOR, FLOAT, SHADER, VECTOR, NodeKind, SocketType

COEFFICIENTS = ("ABSORPTION", "SCATTERING", "EMISSION")
PHASES = ("HENYEY_GREENSTEIN", "FOURNIER_FORAND", "DRAINE", "RAYLEIGH", "MIE")
MIE_LOBES = ("HENYEY_GREENSTEIN", "DRAINE")
"""Phase functions whose mixture stands for Mie's (Jendersie and d'Eon 2023)."""
Constants("Volumes", COEFFICIENT=COEFFICIENTS, VOLUME_PHASE=PHASES, MIE_LOBE=MIE_LOBES)


def _volume(inputs: dict[str, tuple[SocketType, object]], options: dict[str, tuple] | None = None) -> NodeKind:
    return NodeKind("volumes.glsl", inputs, {"volume": SHADER}, options or {})


_PHASE_INPUTS = {
    "anisotropy": (FLOAT, 0.0),
    "ior": (FLOAT, 1.33),
    "backscatter": (FLOAT, 0.1),
    "alpha": (FLOAT, 0.5),
    "diameter": (FLOAT, 20.0),
}
_PHASE_OPTIONS = {"phase": PHASES, "mie_lobe": MIE_LOBES}

KINDS = {
    # The surface of a material that has a volume alone: it is not there, and no limit counts it.
    "volume_boundary": NodeKind("volumes.glsl", {}, {"bsdf": SHADER}),
    "volume_absorption": _volume({"color": (COLOR, 0.8), "density": (FLOAT, 1.0)}),
    "volume_scatter": _volume({"color": (COLOR, 0.8), "density": (FLOAT, 1.0), **_PHASE_INPUTS}, _PHASE_OPTIONS),
    "volume_coefficients": _volume(
        {
            "absorption_coefficients": (VECTOR, 1.0),
            "scatter_coefficients": (VECTOR, 1.0),
            "emission_coefficients": (VECTOR, 0.0),
            **_PHASE_INPUTS,
        },
        {"coefficient": COEFFICIENTS, **_PHASE_OPTIONS},
    ),
    "volume_principled": _volume(
        {
            "color": (COLOR, 0.5),
            "color_grid": (COLOR, 1.0),
            "density": (FLOAT, 1.0),
            "density_grid": (FLOAT, 1.0),
            "anisotropy": (FLOAT, 0.0),
            "absorption_color": (COLOR, 0.0),
            "emission_strength": (FLOAT, 0.0),
            "emission_color": (COLOR, 1.0),
            "blackbody_intensity": (FLOAT, 0.0),
            "blackbody_tint": (COLOR, 1.0),
            "temperature": (FLOAT, 1000.0),
            "temperature_grid": (FLOAT, 1.0),
        },
        {"coefficient": COEFFICIENTS},
    ),
}
