# SPDX-License-Identifier: GPL-3.0-or-later
"""Adaptive Subdivision: meshes as they are before the renderer divides them, and how finely it divides them.

As in Cycles, the levels of the modifier say nothing. Blender divides the mesh a few times instead, by its own rules
for creases, boundaries and UV maps, and the renderer goes on from there.
"""

import contextlib
from collections.abc import Iterator

import bpy

from .....scene.meshes import Dicing

_LEAST = 1e-4
_MOST_FACES, _MOST_LEVELS = 1 << 12, 4
"""Number of faces, and of times, up to which Blender divides a mesh."""
_MOST_FACES_CREASED, _MOST_LEVELS_CREASED = 1 << 13, 5
"""The same for a mesh with creases, along which surfaces turn within a short way."""
_CREASES = ("crease_edge", "crease_vert")


def adaptive_modifier(source: bpy.types.Object, render: bool = True) -> bpy.types.SubsurfModifier | None:
    """By what Cycles would divide an evaluated object as large as it is seen: its last modifier, as a render or else a
    viewport shows it."""
    modifier = source.modifiers[-1] if len(source.modifiers) else None
    if (
        modifier is None
        or modifier.type != "SUBSURF"
        or not (modifier.show_render if render else modifier.show_viewport)
    ):
        return None
    # Before Blender 5 a property of Cycles'.
    owner = modifier if hasattr(modifier, "use_adaptive_subdivision") else getattr(source, "cycles", None)
    return modifier if getattr(owner, "use_adaptive_subdivision", False) else None


def export_dicing(source: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> Dicing | None:
    """None where the mesh of an evaluated object, as base_mesh gives it, is not divided further."""
    modifier = adaptive_modifier(source, depsgraph.mode == "RENDER")
    if modifier is None:
        return None
    is_curved = modifier.subdivision_type == "CATMULL_CLARK"
    level = _level_of_base(source, modifier, depsgraph) if _can_divide(source, depsgraph) else None
    if level is None:
        level = _level(modifier, depsgraph)
    if not hasattr(modifier, "use_adaptive_subdivision"):
        return Dicing(max(source.cycles.dicing_rate, _LEAST), True, is_curved, level)
    in_pixels = modifier.adaptive_space == "PIXEL"
    length = modifier.adaptive_pixel_size if in_pixels else modifier.adaptive_object_edge_length
    return Dicing(max(length, _LEAST), in_pixels, is_curved, level)


def has_base_mesh(source: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> bool:
    """True where base_mesh gives another mesh than the object has."""
    modifier = adaptive_modifier(source, depsgraph.mode == "RENDER")
    return (
        modifier is not None
        and _can_divide(source, depsgraph)
        and _level_of_base(source, modifier, depsgraph) != _level(modifier, depsgraph)
    )


@contextlib.contextmanager
def base_mesh(source: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> Iterator[bpy.types.Mesh]:
    """The mesh of an evaluated object with has_base_mesh, divided so often as is best to go on from, valid within the
    with block. The object is what it was afterwards."""
    modifier = source.modifiers[-1]
    before = [_own_level(each, depsgraph) for each in source.modifiers]
    _set_levels(source, [*before[:-1], _level_of_base(source, modifier, depsgraph)], depsgraph)
    try:
        mesh = source.to_mesh(preserve_all_data_layers=True, depsgraph=depsgraph)  # applies the modifiers anew
    finally:
        _set_levels(source, before, depsgraph)
    try:
        yield mesh
    finally:
        source.to_mesh_clear()


def _can_divide(source: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> bool:
    """True where levels can be set without an update of the viewport, which would export the mesh again."""
    if source.type != "MESH" or source.data.is_editmode:
        return False
    return depsgraph.mode == "RENDER" or all(hasattr(modifier, "levels") for modifier in source.modifiers)


def _set_levels(source: bpy.types.Object, levels: list[int], depsgraph: bpy.types.Depsgraph) -> None:
    """Set the level of the last modifier and, where Blender must have all at once, those of the others."""
    if depsgraph.mode == "RENDER":
        source.modifiers[-1].render_levels = levels[-1]
    else:
        source.modifiers.foreach_set("levels", levels)  # other than an assignment it tags nothing


def _own_level(modifier: bpy.types.Modifier, depsgraph: bpy.types.Depsgraph) -> int:
    return getattr(modifier, "render_levels" if depsgraph.mode == "RENDER" else "levels", 0)


def _level(modifier: bpy.types.SubsurfModifier, depsgraph: bpy.types.Depsgraph) -> int:
    """Level by which Blender has divided the evaluated mesh."""
    level, most = _own_level(modifier, depsgraph), _simplified_level(depsgraph)
    return level if most is None else min(level, most)


def _simplified_level(depsgraph: bpy.types.Depsgraph) -> int | None:
    """Level up to which Simplify lets meshes be divided; None is any."""
    render = depsgraph.scene_eval.render
    if not render.use_simplify:
        return None
    return render.simplify_subdivision_render if depsgraph.mode == "RENDER" else render.simplify_subdivision


def _level_of_base(
    source: bpy.types.Object, modifier: bpy.types.SubsurfModifier, depsgraph: bpy.types.Depsgraph
) -> int:
    """Level by which Blender is to divide the mesh: 1 at least where faces bend, as vertices move."""
    level = _level(modifier, depsgraph)
    faces = len(source.data.polygons) / 4 ** (level - 1) if level else len(source.data.loops)
    best = int(modifier.subdivision_type == "CATMULL_CLARK")
    is_creased = any(name in source.data.attributes for name in _CREASES)
    most_faces, most = (_MOST_FACES_CREASED, _MOST_LEVELS_CREASED) if is_creased else (_MOST_FACES, _MOST_LEVELS)
    most = min(most, getattr(getattr(depsgraph.scene_eval, "cycles", None), "max_subdivisions", most))
    while best < most and faces * 4**best <= most_faces:
        best += 1
    simplified = _simplified_level(depsgraph)
    return best if simplified is None else min(best, simplified)
