# SPDX-License-Identifier: GPL-3.0-or-later
"""Subjects that warnings are about, selected in Blender."""

import enum

import bpy


class SubjectKind(enum.Enum):
    """Kind of thing that a warning names at its beginning. The numbers are kept by files and never change."""

    OBJECT = 0
    MATERIAL = 1
    WORLD = 2


def select(context: bpy.types.Context, kind: SubjectKind, name: str, node: str = "") -> str:
    """Make an object, or the objects with a material, the selection and the first of them active.

    Returns "" or, in words, why that could not be done. A node that is named becomes its tree's active one.
    """
    if kind is SubjectKind.WORLD:
        return _activate_node(bpy.data.worlds.get(name), f'world "{name}"', node)
    layer = context.view_layer
    if kind is SubjectKind.OBJECT:
        chosen = [layer.objects[name]] if name in layer.objects else []
        if not chosen:
            return f'the view layer has no object "{name}" any more'
    else:
        material = bpy.data.materials.get(name)
        problem = _activate_node(material, f'material "{name}"', node)
        if problem:
            return problem
        chosen = [thing for thing in layer.objects if any(slot.material == material for slot in thing.material_slots)]
        if not chosen:
            return f'no object of the view layer has the material "{name}"'
        slots = [slot.material for slot in chosen[0].material_slots]
        chosen[0].active_material_index = slots.index(material)
    for thing in layer.objects:
        thing.select_set(thing in chosen)
    layer.objects.active = chosen[0]
    return "" if any(thing.visible_get() for thing in chosen) else f'"{chosen[0].name}" is selected but hidden'


def _activate_node(owner: bpy.types.Material | bpy.types.World | None, description: str, node: str) -> str:
    if owner is None:
        return f"the file has no {description} any more"
    tree = owner.node_tree
    if node and tree is not None and node in tree.nodes:
        for other in tree.nodes:
            other.select = other.name == node
        tree.nodes.active = tree.nodes[node]
    return ""
