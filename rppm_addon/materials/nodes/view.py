# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights by the angle of view, directions between spaces, and the light falloff by distance."""

from ...gl.buffers.constants import Constants
from .node_kinds import FLOAT, VECTOR, NodeKind

UP = (0.0, 0.0, 1.0)
_VECTOR_TYPES = ("POINT", "VECTOR", "NORMAL")
_SPACES = ("WORLD", "OBJECT", "CAMERA")
Constants("VectorTransforms", TRANSFORM=_VECTOR_TYPES, SPACE=_SPACES)

KINDS = {
    "fresnel": NodeKind(
        "fresnel_nodes.glsl", {"ior": (FLOAT, 1.5), "normal": (VECTOR, "normal")}, {"fac": FLOAT}, surface=True
    ),
    "layer_weight": NodeKind(
        "fresnel_nodes.glsl",
        {"blend": (FLOAT, 0.5), "normal": (VECTOR, "normal")},
        {"fresnel": FLOAT, "facing": FLOAT},
        surface=True,
    ),
    # `direction` is the value of the output Normal, which the user turns.
    "normal": NodeKind(
        "direction.glsl",
        {"normal": (VECTOR, UP), "direction": (VECTOR, UP)},
        {"normal": VECTOR, "dot": FLOAT},
    ),
    "vector_transform": NodeKind(
        "vector_transform.glsl",
        {"vector": (VECTOR, (0.5, 0.5, 0.5))},
        {"vector": VECTOR},
        {
            "vector_type": _VECTOR_TYPES,
            "convert_from": _SPACES,
            "convert_to": _SPACES,
        },
        surface=True,
    ),
    # `ray_length` is the distance from the light.
    "light_falloff": NodeKind(
        "light_falloff.glsl",
        {"strength": (FLOAT, 100.0), "smooth": (FLOAT, 0.0), "ray_length": (FLOAT, 1.0)},
        {"quadratic": FLOAT, "linear": FLOAT, "constant": FLOAT},
    ),
}
