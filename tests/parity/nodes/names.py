# SPDX-License-Identifier: GPL-3.0-or-later
"""Names of Blender's nodes."""

BLENDER_NODES = {
    "rgb_to_bw": "RGBToBW", "separate_xyz": "SeparateXYZ", "combine_xyz": "CombineXYZ", "val_to_rgb": "ValToRGB",
    "rgb_curve": "RGBCurve", "mix_rgb": "MixRGB", "map_range_vector": "MapRange", "mix_float": "Mix",
    "mix_vector": "Mix", "mix_vector_non_uniform": "Mix", "mix_color": "Mix", "bsdf_glossy": "BsdfAnisotropic",
}  # fmt: skip
"""Names where they do not follow from those of our kinds."""


def blender_node(kind: str) -> str:
    """The bl_idname of the node of one of our kinds."""
    return "ShaderNode" + BLENDER_NODES.get(kind, "".join(word.capitalize() for word in kind.split("_")))
