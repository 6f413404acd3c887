# SPDX-License-Identifier: GPL-3.0-or-later
"""The meshes of a scene under export, each exported once and as long as it does not change."""

import contextlib
import dataclasses
import heapq
from collections.abc import Iterator

import bpy

from ....scene import Mesh
from ..report import Report
from .attributes import add_attributes
from .meshes import NO_MESH, export_mesh


class MeshTable:
    """Evaluated meshes by the memory that they lie in.

    Evaluated data is shared exactly when it is the same block of memory: session_uid is also shared by copies that
    different modifiers made different. A block may be freed and used again, so from one pass over the scene to the
    next it is believed only of the owners that it had.
    """

    def __init__(self, report: Report) -> None:
        self.meshes: list[Mesh] = []
        """Those that nothing uses any more are empty."""
        self._report = report
        self._places: dict[int, int | None] = {}
        self._owners: dict[int, set[int]] = {}
        self._seen: set[int] = set()
        self._free: list[int] = []
        """Places of empty meshes, as a heap."""
        self._tried: dict[int, set[str]] = {}
        self._keys: dict[int, int] = {}
        self._before: dict[int, Mesh] = {}
        """By owner, what was forgotten and may come again with other positions."""

    def begin_pass(self) -> None:
        """All uses of meshes follow."""
        self._seen = set()

    def end_pass(self) -> None:
        """Meshes that were not used since begin_pass are forgotten."""
        for key in self._places.keys() - self._seen:
            self._drop(key)
        self._before = {}

    def keep(self, place: int) -> None:
        """A mesh is used as before."""
        self._seen.add(self._keys[place])

    def knows(self, place: int) -> bool:
        """Whether a mesh has not been forgotten."""
        return place in self._keys

    def add_owner(self, place: int, owner: int) -> None:
        """An object brings a mesh that others have brought in this pass."""
        self._owners[self._keys[place]].add(owner)

    def forget(self, owners: set[int]) -> None:
        """What these objects showed has changed."""
        self._before = {}
        for key in [key for key, known in self._owners.items() if known & owners] if owners else ():
            place = self._places[key]
            if place is not None:
                self._before.update(dict.fromkeys(self._owners[key], self.meshes[place]))
            self._drop(key)

    def _drop(self, key: int) -> None:
        place = self._places.pop(key)
        self._owners.pop(key)
        self._seen.discard(key)
        if place is not None:
            self.meshes[place] = NO_MESH
            heapq.heappush(self._free, place)
            self._tried.pop(place)
            self._keys.pop(place)

    def index(
        self, source: bpy.types.Object, mesh: bpy.types.Mesh | None, attributes: set[str], owner: int
    ) -> int | None:
        """Index of a mesh, exported now if it is new, with the named attributes; None when it has no triangles.

        mesh: None lets Blender make one of the object. owner: the session_uid of the object that brings the mesh.
        """
        key = (source if mesh is None else mesh).as_pointer()
        # What multiplies an object may bring the mesh that the object itself had before.
        bringers = owner, source.original.session_uid
        if key in self._places and key not in self._seen and self._owners[key].isdisjoint(bringers):
            self._drop(key)
        if key not in self._places:
            self._report.progress(f"Exporting {source.name}")
            with self._report.about(("mesh", owner, source.name)):
                self._places[key] = self._add(source, mesh, attributes, self._before.pop(owner, None))
            self._owners[key] = set()
        self._seen.add(key)
        self._owners[key].add(owner)
        place = self._places[key]
        if place is not None:
            self._keys[place] = key
        if place is not None and not attributes <= self._tried[place]:
            with _mesh_of(source, mesh) as evaluated:
                self._complete(place, evaluated, attributes)
        return place

    def _add(
        self, source: bpy.types.Object, mesh: bpy.types.Mesh | None, attributes: set[str], before: Mesh | None
    ) -> int | None:
        with _mesh_of(source, mesh) as evaluated:
            exported = None if evaluated is None else export_mesh(evaluated, source.name, self._report, before)
            if exported is None:
                return None
            place = heapq.heappop(self._free) if self._free else len(self.meshes)
            self.meshes[place : place + 1] = [exported]
            self._tried[place] = set()
            self._complete(place, evaluated, attributes, before)
        return place

    def _complete(self, place: int, mesh: bpy.types.Mesh, attributes: set[str], before: Mesh | None = None) -> None:
        """Read attributes that were not asked for before; meshes that were handed out stay as they are."""
        known = self.meshes[place]
        self.meshes[place] = dataclasses.replace(known, attributes=dict(known.attributes))
        add_attributes(self.meshes[place], mesh, attributes, before)
        self._tried[place] |= attributes


@contextlib.contextmanager
def _mesh_of(source: bpy.types.Object, mesh: bpy.types.Mesh | None) -> Iterator[bpy.types.Mesh | None]:
    """The evaluated mesh given, or else one that Blender makes of the object; None when it has no geometry."""
    if mesh is not None:
        yield mesh
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
