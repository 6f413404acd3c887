# SPDX-License-Identifier: GPL-3.0-or-later
"""Texture mapping: what a texture node does to its coordinates itself, in the panel Texture Mapping of the editor."""

import bpy

from .....scene import Link, NodeGraph

_AXES = ("X", "Y", "Z")


def is_mapped(node: bpy.types.Node) -> bool:
    """Return whether a texture node changes the coordinates that it is given."""
    mapping = getattr(node, "texture_mapping", None)
    if mapping is None:
        return False
    values = (*mapping.translation, *mapping.rotation, *(factor - 1.0 for factor in mapping.scale))
    return any(values) or _axes_of(mapping) != _AXES or mapping.vector_type == "NORMAL"


def mapped(graph: NodeGraph, name: str, node: bpy.types.Node, vector: object) -> object:
    """Return coordinates as a texture node's mapping turns them: axes exchanged, then as by a Mapping node.

    vector: a Link or a tuple of three, which is returned for nodes other than textures and for those whose mapping does
    nothing; name: of the node, for messages.
    """
    if not is_mapped(node):
        return vector
    mapping, add = node.texture_mapping, graph.add
    axes = _axes_of(mapping)
    if axes != _AXES:
        separated = add("separate_xyz", "x", name=name, vector=vector).node
        given = {
            target.lower(): Link(separated, axis.lower()) if axis != "NONE" else 0.0
            for target, axis in zip(_AXES, axes, strict=True)
        }
        vector = add("combine_xyz", "vector", name=name, **given)
    return add(
        "mapping", "vector", name=name, options={"vector_type": mapping.vector_type}, vector=vector,
        location=tuple(mapping.translation), rotation=tuple(mapping.rotation), scale=tuple(mapping.scale),
    )  # fmt: skip


def _axes_of(mapping: bpy.types.TexMapping) -> tuple[str, ...]:
    return mapping.mapping_x, mapping.mapping_y, mapping.mapping_z
