# SPDX-License-Identifier: GPL-3.0-or-later
"""Node kind of the stand-ins for materials (materials/placeholders/stand_in.py), which is no node of Blender's."""

from .node_kinds import COLOR, FLOAT, SHADER, NodeKind

KINDS = {
    "plain_surface": NodeKind(
        "plain_surface.glsl",
        {
            "color": (COLOR, 1.0),
            "texture": (COLOR, 1.0),
            "texture_factor": (FLOAT, 0.0),
            "metallic": (FLOAT, 0.0),
            "roughness": (FLOAT, 1.0),
            "glass": (FLOAT, 0.0),
            "transparent": (FLOAT, 0.0),
            "emission": (COLOR, 0.0),
        },
        {"surface": SHADER},
    )
}
