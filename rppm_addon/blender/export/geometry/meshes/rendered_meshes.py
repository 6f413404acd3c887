# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes as they are rendered, also in Edit Mode, where Blender keeps them in another form, and which are not."""

import contextlib
from collections.abc import Iterator

import bpy

from .base_meshes import BaseMeshes


def is_made_anew(source: bpy.types.Object, data: object, bases: BaseMeshes | None) -> bool:
    """True for the data of objects of which rendered_mesh has Blender make a mesh: none, a mesh in Edit Mode, or one
    that the renderer divides."""
    if data is None or (isinstance(data, bpy.types.Mesh) and data.is_editmode):
        return True
    return bases is not None and bases.divides(source, data)


def has_no_faces(mesh: bpy.types.Mesh) -> bool:
    """True where an evaluated mesh is known to have no faces; in Edit Mode it may count none and have some."""
    return len(mesh.polygons) == 0 and not mesh.is_editmode


@contextlib.contextmanager
def rendered_mesh(
    source: bpy.types.Object, data: bpy.types.Mesh | None, bases: BaseMeshes | None
) -> Iterator[bpy.types.Mesh | None]:
    """The mesh of an evaluated object with its vertices, faces and attributes, valid within the with block.

    source: no object that Blender's iterator makes up for an instance. data: what an instance of the object has; None
    has Blender make a mesh of the object. None is yielded where it has no geometry. In Edit Mode an evaluated mesh has
    the attributes of the mesh under edit: as in Cycles, Blender makes one of the object, which leaves out the modifiers
    that are off in Edit Mode. bases: meshes with Adaptive Subdivision, for the renderer to divide; None leaves them as
    their modifiers have them.
    """
    if data is not None and bases is not None and bases.divides(source, data):
        with bases.mesh(source) as base:
            yield base
        return
    if data is not None and not (data.is_editmode and data == source.data):
        yield data
        return
    try:
        made = source.to_mesh()
    except RuntimeError:
        made = None
    try:
        yield made
    finally:
        if made is not None:
            source.to_mesh_clear()
