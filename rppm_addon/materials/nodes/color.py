# SPDX-License-Identifier: GPL-3.0-or-later
"""Colors: mixed, adjusted, taken apart and put together."""

from ...gl.buffers.constants import Constants
from .node_kinds import BOOLEAN, COLOR, FLOAT, VECTOR, NodeKind

BLEND_TYPES = (
    "MIX", "DARKEN", "MULTIPLY", "BURN", "LIGHTEN", "SCREEN", "DODGE", "ADD", "OVERLAY", "SOFT_LIGHT", "LINEAR_LIGHT",
    "DIFFERENCE", "EXCLUSION", "SUBTRACT", "DIVIDE", "HUE", "SATURATION", "COLOR", "VALUE",
)  # fmt: skip
MODES = ("RGB", "HSV", "HSL")
Constants("ColorModes", MODE=MODES)
GRAY = (0.5, 0.5, 0.5)
LIGHT_GRAY = (0.8, 0.8, 0.8)

KINDS = {
    "mix_color": NodeKind(
        "mix_color.glsl",
        {"factor_float": (FLOAT, 0.5), "a_color": (COLOR, GRAY), "b_color": (COLOR, GRAY)},
        {"result_color": COLOR},
        {"blend_type": BLEND_TYPES, "clamp_factor": BOOLEAN, "clamp_result": BOOLEAN},
        function_option="blend_type",
    ),
    "mix_rgb": NodeKind(
        "mix_color.glsl",
        {"fac": (FLOAT, 0.5), "color1": (COLOR, GRAY), "color2": (COLOR, GRAY)},
        {"color": COLOR},
        {"blend_type": BLEND_TYPES, "use_clamp": BOOLEAN},
        function_option="blend_type",
    ),
    "invert": NodeKind("color.glsl", {"fac": (FLOAT, 1.0), "color": (COLOR, (0.0, 0.0, 0.0))}, {"color": COLOR}),
    "gamma": NodeKind("color.glsl", {"color": (COLOR, (1.0, 1.0, 1.0)), "gamma": (FLOAT, 1.0)}, {"color": COLOR}),
    "bright_contrast": NodeKind(
        "color.glsl",
        {"color": (COLOR, (1.0, 1.0, 1.0)), "bright": (FLOAT, 0.0), "contrast": (FLOAT, 0.0)},
        {"color": COLOR},
    ),
    "hue_saturation": NodeKind(
        "color.glsl",
        {
            "hue": (FLOAT, 0.5),
            "saturation": (FLOAT, 1.0),
            "value": (FLOAT, 1.0),
            "fac": (FLOAT, 1.0),
            "color": (COLOR, LIGHT_GRAY),
        },
        {"color": COLOR},
    ),
    "rgb_to_bw": NodeKind("color.glsl", {"color": (COLOR, GRAY)}, {"val": FLOAT}),
    "separate_color": NodeKind(
        "convert.glsl",
        {"color": (COLOR, LIGHT_GRAY)},
        {"red": FLOAT, "green": FLOAT, "blue": FLOAT},
        {"mode": MODES},
    ),
    "combine_color": NodeKind(
        "convert.glsl",
        {"red": (FLOAT, 0.0), "green": (FLOAT, 0.0), "blue": (FLOAT, 0.0)},
        {"color": COLOR},
        {"mode": MODES},
    ),
    "separate_xyz": NodeKind(
        "convert.glsl", {"vector": (VECTOR, (0.0, 0.0, 0.0))}, {"x": FLOAT, "y": FLOAT, "z": FLOAT}
    ),
    "combine_xyz": NodeKind(
        "convert.glsl", {"x": (FLOAT, 0.0), "y": (FLOAT, 0.0), "z": (FLOAT, 0.0)}, {"vector": VECTOR}
    ),
}
