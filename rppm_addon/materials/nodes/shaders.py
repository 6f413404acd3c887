# SPDX-License-Identifier: GPL-3.0-or-later
"""Shader nodes."""

from ..node_kinds import COLOR, FLOAT, SHADER, NodeKind


def _shader(output: str = "bsdf", **members: object) -> NodeKind:
    return NodeKind("shaders.glsl", outputs={output: SHADER}, **members)


_COLOR = {"color": (COLOR, 0.8)}

KINDS = {
    "mix_shader": _shader("shader", inputs={"fac": (FLOAT, 0.5)}),
    "add_shader": _shader("shader"),
    "bsdf_diffuse": _shader(inputs=_COLOR),
    "bsdf_glossy": _shader(
        inputs=_COLOR | {"roughness": (FLOAT, 0.5)},
        options={"distribution": ("GGX", "BECKMANN", "ASHIKHMIN_SHIRLEY", "MULTI_GGX")},
    ),
    "bsdf_glass": _shader(
        inputs={"color": (COLOR, 1.0), "roughness": (FLOAT, 0.0), "ior": (FLOAT, 1.5)},
        options={"distribution": ("GGX", "BECKMANN", "MULTI_GGX")},
    ),
    "bsdf_refraction": _shader(inputs={"color": (COLOR, 1.0), "roughness": (FLOAT, 0.0), "ior": (FLOAT, 1.5)}),
    "bsdf_transparent": _shader(inputs={"color": (COLOR, 1.0)}),
    "emission": _shader("emission", inputs={"color": (COLOR, 1.0), "strength": (FLOAT, 1.0)}),
    # Of a volume, which has no surface, the "emission" is its absorption coefficient in 1/m.
    "volume_absorption": _shader("volume", inputs={"color": (COLOR, 0.8), "density": (FLOAT, 1.0)}),
    "background": _shader("background", inputs={"color": (COLOR, 0.8), "strength": (FLOAT, 1.0)}),
    "bsdf_principled": _shader(
        inputs={
            "base_color": (COLOR, 0.8), "metallic": (FLOAT, 0.0), "roughness": (FLOAT, 0.5), "ior": (FLOAT, 1.5),
            "alpha": (FLOAT, 1.0), "specular_ior_level": (FLOAT, 0.5), "specular_tint": (COLOR, 1.0),
            "transmission_weight": (FLOAT, 0.0), "emission_color": (COLOR, 1.0), "emission_strength": (FLOAT, 0.0),
        },
        options={"distribution": ("GGX", "MULTI_GGX")},
    ),
}  # fmt: skip
