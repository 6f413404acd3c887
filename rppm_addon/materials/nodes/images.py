# SPDX-License-Identifier: GPL-3.0-or-later
"""Image and environment textures, and photometric profiles."""

from ...gl.buffers.constants import Constants
from .node_kinds import BOOLEAN, COLOR, FLOAT, VECTOR, NodeKind

_INTERPOLATIONS = ("Linear", "Closest", "Cubic", "Smart")
_EXTENSIONS = ("REPEAT", "EXTEND", "CLIP", "MIRROR")
_PROJECTIONS = ("FLAT", "BOX", "SPHERE", "TUBE")
_ENVIRONMENT_PROJECTIONS = ("EQUIRECTANGULAR", "MIRROR_BALL", "SKY")
Constants("ImageSampling", INTERPOLATION=_INTERPOLATIONS, EXTENSION=_EXTENSIONS)
Constants("ImageProjections", IMAGE=_PROJECTIONS, ENVIRONMENT=_ENVIRONMENT_PROJECTIONS)

KINDS = {
    "tex_image": NodeKind(
        "images.glsl",
        inputs={"vector": (VECTOR, 0.0), "projection_blend": (FLOAT, 0.0)},
        outputs={"color": COLOR, "alpha": FLOAT},
        options={
            "projection": _PROJECTIONS,
            "interpolation": _INTERPOLATIONS,
            "extension": _EXTENSIONS,
            "unassociate": BOOLEAN,
        },
        resources=("image",),
        surface=True,
    ),
    "tex_image_tiles": NodeKind(
        "images.glsl",
        inputs={"tiles": (FLOAT, 0.0), "vector": (VECTOR, 0.0)},
        outputs={"color": COLOR, "alpha": FLOAT},
        options={"interpolation": _INTERPOLATIONS, "extension": _EXTENSIONS, "unassociate": BOOLEAN},
        resources=("table",),
    ),
    "tex_environment": NodeKind(
        "images.glsl",
        inputs={"vector": (VECTOR, 0.0)},
        outputs={"color": COLOR},
        options={"projection": _ENVIRONMENT_PROJECTIONS, "interpolation": _INTERPOLATIONS},
        resources=("image",),
    ),
    "tex_ies": NodeKind(
        "ies.glsl",
        inputs={"vector": (VECTOR, 0.0), "strength": (FLOAT, 1.0)},
        outputs={"fac": FLOAT},
        resources=("table",),
    ),
}
