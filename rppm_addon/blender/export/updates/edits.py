# SPDX-License-Identifier: GPL-3.0-or-later
"""Changes that a depsgraph reports."""

from dataclasses import dataclass, field

import bpy
import numpy as np


@dataclass
class Edits:
    """Changes that a depsgraph reports, with the evaluated data-blocks."""

    objects: dict[int, bpy.types.Object] = field(default_factory=dict)
    """Evaluated objects by session_uid."""
    shapes: set[int] = field(default_factory=set)
    """session_uid of the objects whose geometry has changed."""
    looks: set[int] = field(default_factory=set)
    """session_uid of the objects of which more may have changed than where they are, such as their materials."""
    materials: list[bpy.types.Material] = field(default_factory=list)
    world: bool = False
    images: bool = False
    others: bool = False
    """Whether objects may have come, gone or changed in other ways: all instances are listed anew."""


@dataclass
class PendingEdits:
    """Changes since the newest scene, by session_uid: nothing of Blender is held."""

    objects: set[int] = field(default_factory=set)
    shapes: set[int] = field(default_factory=set)
    looks: set[int] = field(default_factory=set)
    materials: set[int] = field(default_factory=set)
    others: bool = False
    attributes: bool = False
    """Whether materials ask for other attributes than before."""
    has_untracked: bool = False
    """Whether materials that rest on what the depsgraph does not report are among them."""

    def add(self, edits: Edits) -> None:
        """Add changes that a depsgraph reports."""
        self.objects |= edits.objects.keys()
        self.shapes |= edits.shapes
        self.looks |= edits.looks
        self.materials |= {material.original.session_uid for material in edits.materials}
        self.others |= edits.others


def read_edits(depsgraph: bpy.types.Depsgraph) -> Edits:
    """The updates of a depsgraph since it was last evaluated."""
    edits = Edits()
    shapes, looks = (_flags(depsgraph.updates, name) for name in ("is_updated_geometry", "is_updated_shading"))
    for number, update in enumerate(depsgraph.updates):
        block = update.id
        if isinstance(block, bpy.types.Object):
            uid = block.original.session_uid
            edits.objects[uid] = block
            if shapes[number]:
                edits.shapes.add(uid)
            if shapes[number] or looks[number]:
                edits.looks.add(uid)
        elif isinstance(block, bpy.types.Material):
            edits.materials.append(block)
        elif isinstance(block, bpy.types.World):
            edits.world = True
        elif isinstance(block, bpy.types.Image):
            edits.images = True
        elif not isinstance(block, _REPORTED_WITH_USERS):
            edits.others = True
    edits.others |= not depsgraph.updates
    return edits


def _flags(updates: bpy.types.bpy_prop_collection, name: str) -> list[bool]:
    values = np.zeros(len(updates), bool)
    if len(values):
        updates.foreach_get(name, values)
    return values.tolist()


_REPORTED_WITH_USERS = (
    bpy.types.NodeTree, bpy.types.Light, bpy.types.Camera, bpy.types.Mesh, bpy.types.Curve, bpy.types.MetaBall,
    bpy.types.Armature, bpy.types.Lattice, bpy.types.Key, bpy.types.Action,
)  # fmt: skip
"""Types of data-blocks with which Blender also reports the objects or materials that they change."""
