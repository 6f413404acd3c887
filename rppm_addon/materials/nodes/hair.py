# SPDX-License-Identifier: GPL-3.0-or-later
"""Shader nodes of fibers."""

from .node_kinds import COLOR, FLOAT, SHADER, VECTOR, NodeKind

_BSDF = {"bsdf": SHADER}

KINDS = {
    # Without a tangent, which is 0 then, fibers run along strands, or along an edge of each triangle.
    "bsdf_hair": NodeKind(
        "hair.glsl",
        inputs={
            "color": (COLOR, 0.8),
            "offset": (FLOAT, 0.0),
            "roughnessu": (FLOAT, 0.1),
            "roughnessv": (FLOAT, 1.0),
            "tangent": (VECTOR, 0.0),
        },
        outputs=_BSDF,
        options={"component": ("Reflection", "Transmission")},
        surface=True,
    ),
    "bsdf_hair_principled": NodeKind(
        "hair.glsl",
        inputs={
            "color": (COLOR, (0.017513, 0.005763, 0.002059)),
            "melanin": (FLOAT, 0.8),
            "melanin_redness": (FLOAT, 1.0),
            "tint": (COLOR, 1.0),
            "absorption_coefficient": (VECTOR, (0.245531, 0.52, 1.365)),
            "aspect_ratio": (FLOAT, 0.85),
            "roughness": (FLOAT, 0.3),
            "radial_roughness": (FLOAT, 0.3),
            "coat": (FLOAT, 0.0),
            "ior": (FLOAT, 1.55),
            "offset": (FLOAT, 0.0349066),
            "random_color": (FLOAT, 0.0),
            "random_roughness": (FLOAT, 0.0),
            "random": (FLOAT, 0.0),
            "r_lobe": (FLOAT, 1.0),
            "tt_lobe": (FLOAT, 1.0),
            "trt_lobe": (FLOAT, 1.0),
            "strand_random": (FLOAT, -1.0),
        },
        outputs=_BSDF,
        options={"model": ("CHIANG", "HUANG"), "parametrization": ("ABSORPTION", "MELANIN", "COLOR")},
        surface=True,
    ),
}
