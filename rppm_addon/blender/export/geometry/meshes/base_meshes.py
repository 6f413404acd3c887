# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes with Adaptive Subdivision, as they are before the renderer divides them.

As in Cycles, the levels of the modifier say nothing. Blender divides a mesh a few times instead, by its own rules for
creases, borders and UV maps, and the renderer goes on from there: more often what is seen large.
"""

import contextlib
import math
from collections.abc import Iterator

import bpy
import numpy as np

from .....scene import Camera
from .....scene.errors import SceneError
from .....scene.meshes import Dicing
from ...camera.camera import export_camera
from .dicing import adaptive_modifier, export_dicing

_MOST_LEVELS, _MOST_FACES = 6, 1 << 16
"""Number of times, and of faces, up to which Blender divides what bends."""
_MOST_LEVELS_FLAT, _MOST_FACES_FLAT = 4, 1 << 12
"""The same for what stays flat."""
_MOST_FACES_MULTIPLIED = 1 << 13
"""Number of faces up to which Blender divides what other objects multiply, which may be seen anywhere."""
_PHYSICS = {
    "CLOTH", "COLLISION", "DYNAMIC_PAINT", "EXPLODE", "FLUID", "PARTICLE_INSTANCE", "PARTICLE_SYSTEM", "SOFT_BODY",
}  # fmt: skip
"""Types of modifiers that go on from what they were at, so that applying them anew may change the object."""
_LONGEST = 1.5
"""Length of edges, in units of the length that is asked for, from which on Blender divides a mesh no more."""
_NEAREST = 0.05
"""Least distance from which an object is seen, in units of its size."""


class BaseMeshes:
    """Levels by which Blender divides the meshes of a depsgraph with Adaptive Subdivision.

    A level is kept until the mesh is exported anew, so that attributes and shapes at other times fit.
    """

    def __init__(self, depsgraph: bpy.types.Depsgraph, viewport: bool) -> None:
        self.read_from(depsgraph, viewport)
        self._levels: dict[int, int | None] = {}
        """By the session_uid of an original object; None where its mesh is taken as its modifiers have it."""
        self._multiplied: dict[int, bool] = {}
        """By the session_uid of original objects with Adaptive Subdivision, whether other objects show them."""

    def read_from(self, depsgraph: bpy.types.Depsgraph, viewport: bool) -> None:
        """Take the objects of a depsgraph as they are now."""
        self._depsgraph = depsgraph
        cycles = getattr(depsgraph.scene_eval, "cycles", None)
        self._rate = getattr(cycles, "preview_dicing_rate" if viewport else "dicing_rate", 8.0 if viewport else 1.0)
        self._camera: Camera | None = None
        if not viewport:
            with contextlib.suppress(SceneError):
                self._camera = export_camera(depsgraph.scene_eval, depsgraph, getattr(cycles, "dicing_camera", None))

    def renew(self, source: bpy.types.Object, is_multiplied: bool) -> bool:
        """Decide the level of an evaluated object anew; return True where it is another than before.

        is_multiplied: another object shows it.
        """
        key = source.original.session_uid
        before = self._levels.get(key)
        self._levels[key] = self._decided(source, is_multiplied)
        self._multiplied.pop(key, None)
        if adaptive_modifier(source, self._is_render) is not None:
            self._multiplied[key] = is_multiplied
        return self._levels[key] != before

    def outdated(self) -> set[int]:
        """Return the session_uid of the original objects for which another level is best by now, as they are seen
        larger or smaller."""
        if not self._multiplied:
            return set()
        known = {source.original.session_uid: source for source in self._depsgraph.objects}
        return {
            key
            for key, is_multiplied in self._multiplied.items()
            if key in known and self._decided(known[key], is_multiplied) != self._levels[key]
        }

    def divides(self, source: bpy.types.Object, data: object) -> bool:
        """True where ``mesh`` gives another mesh than the data of an evaluated object."""
        return self._level(source) is not None and data == source.data

    @contextlib.contextmanager
    def mesh(self, source: bpy.types.Object) -> Iterator[bpy.types.Mesh]:
        """The mesh of an evaluated object, divided to its level, valid within the with block; the object is what it was
        afterwards."""
        level = self._level(source)
        assert level is not None
        before = [self._own_level(modifier) for modifier in source.modifiers]
        self._set_levels(source, [*before[:-1], level])
        try:
            mesh = source.to_mesh(preserve_all_data_layers=True, depsgraph=self._depsgraph)  # modifies it anew
        finally:
            self._set_levels(source, before)
        try:
            yield mesh
        finally:
            source.to_mesh_clear()

    def dicing(self, source: bpy.types.Object) -> Dicing | None:
        """Fineness to which the renderer divides the mesh of an evaluated object; None where it does not."""
        modifier = adaptive_modifier(source, self._is_render)
        if modifier is None:
            return None
        level = self._level(source)
        return export_dicing(source, modifier, self._applied_level(modifier) if level is None else level)

    @property
    def _is_render(self) -> bool:
        return self._depsgraph.mode == "RENDER"

    def _level(self, source: bpy.types.Object) -> int | None:
        key = source.original.session_uid
        if key not in self._levels:
            self.renew(source, False)
        return self._levels[key]

    def _decided(self, source: bpy.types.Object, is_multiplied: bool) -> int | None:
        modifier = adaptive_modifier(source, self._is_render)
        if modifier is None or source.type != "MESH" or source.data.is_editmode:
            return None
        if any(each.type in _PHYSICS for each in source.modifiers):
            return None
        if not self._is_render and (
            source.mode != "OBJECT"
            # An assignment to these alone would tag the object, which would then be exported again.
            or not all(hasattr(each, "levels") for each in source.modifiers)
        ):
            return None
        applied, best = self._applied_level(modifier), self._best_level(source, modifier, is_multiplied)
        return None if best == applied else best

    def _best_level(self, source: bpy.types.Object, modifier: bpy.types.SubsurfModifier, is_multiplied: bool) -> int:
        """Level that is best to go on from: 1 at least where faces bend, as vertices move."""
        applied = self._applied_level(modifier)
        faces = len(source.data.polygons) / 4 ** (applied - 1) if applied else len(source.data.loops)
        is_curved = modifier.subdivision_type == "CATMULL_CLARK"
        most, most_faces = (_MOST_LEVELS, _MOST_FACES) if is_curved else (_MOST_LEVELS_FLAT, _MOST_FACES_FLAT)
        if is_multiplied:
            most_faces = min(most_faces, _MOST_FACES_MULTIPLIED)
        cycles = getattr(self._depsgraph.scene_eval, "cycles", None)
        most = min(most, getattr(cycles, "max_subdivisions", most))
        # Divided to a level, an object has faces * 4^(level - 1) of them, about half of which face the camera.
        size = self._size(source, export_dicing(source, modifier, 0), is_multiplied) if is_curved else math.inf
        best = int(is_curved)
        while best < most and faces * 4**best <= most_faces and size > _LONGEST * math.sqrt(faces * 4.0**best / 8.0):
            best += 1
        simplified = self._simplified_level
        return best if simplified is None else min(best, simplified)

    def _size(self, source: bpy.types.Object, dicing: Dicing, is_multiplied: bool) -> float:
        """Size of an object in units of the length that its edges are to have; where it is not known how large it is
        seen, it fills the picture."""
        corners = np.array(source.bound_box)
        low, high = corners.min(axis=0), corners.max(axis=0)
        size, unit = float(np.linalg.norm(high - low)), dicing.edge_length * self._rate
        if not dicing.in_pixels:
            return size / unit
        camera = self._camera
        if camera is None or is_multiplied or camera.panorama is not None:
            render = self._depsgraph.scene_eval.render
            return render.resolution_x * render.resolution_percentage / 100 / unit
        matrix = np.array(source.matrix_world)
        size *= float(np.linalg.norm(matrix[:3, :3], axis=0).max())
        center = matrix[:3, :3] @ (0.5 * (low + high)) + matrix[:3, 3]
        distance = float(np.linalg.norm(center - camera.matrix[:3, 3])) - 0.5 * size
        distance = 1.0 if camera.orthographic else max(distance, _NEAREST * size, 1e-30)
        return size / (max(camera.pixel_size, 1e-30) * distance * unit)

    @property
    def _simplified_level(self) -> int | None:
        """Level up to which Simplify lets meshes be divided; None is any."""
        render = self._depsgraph.scene_eval.render
        if not render.use_simplify:
            return None
        return render.simplify_subdivision_render if self._is_render else render.simplify_subdivision

    def _own_level(self, modifier: bpy.types.Modifier) -> int:
        return getattr(modifier, "render_levels" if self._is_render else "levels", 0)

    def _applied_level(self, modifier: bpy.types.SubsurfModifier) -> int:
        """Level by which Blender has divided the evaluated mesh."""
        level, simplified = self._own_level(modifier), self._simplified_level
        return level if simplified is None else min(level, simplified)

    def _set_levels(self, source: bpy.types.Object, levels: list[int]) -> None:
        """Set the level of the last modifier and, where Blender must have all at once, those of the others."""
        if self._is_render:
            source.modifiers[-1].render_levels = levels[-1]
        else:
            source.modifiers.foreach_set("levels", levels)  # other than an assignment it tags nothing
