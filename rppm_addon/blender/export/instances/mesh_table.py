# SPDX-License-Identifier: GPL-3.0-or-later
"""The meshes of a scene under export, each exported once and as long as it does not change."""

import contextlib
import dataclasses
import heapq
from collections.abc import Hashable, Iterator
from typing import Any

import bpy

from ....scene import Mesh, MeshShape
from ....scene.storage.sharing import equal
from ..common.slices import Slices
from ..context import ExportContext
from ..geometry.meshes.attributes import export_attribute
from ..geometry.meshes.base_meshes import BaseMeshes
from ..geometry.meshes.meshes import NO_MESH, export_mesh
from ..geometry.meshes.rendered_meshes import is_made_anew, rendered_mesh
from ..geometry.strands.round_meshes import RoundSource, export_round, export_round_attribute
from ..geometry.strands.tubes import Rings
from ..geometry.volumes.volume_meshes import GridSource, export_grids


class MeshTable:
    """Evaluated meshes by the memory that they lie in.

    Evaluated data is shared exactly when it is the same block of memory: session_uid is also shared by copies that
    different modifiers made different. A block may be freed and used again, so from one pass over the scene to the
    next it is believed only of the owners that it had.
    """

    def __init__(self, context: ExportContext) -> None:
        self.meshes: list[Mesh] = []
        """Exported meshes; meshes that nothing uses any more are empty."""
        self.rings: dict[int, Rings] = {}
        """Rings of the tubes of meshes of strands, by the places of the meshes."""
        self._context = context
        self._report = context.report
        self._places: dict[int, int | None] = {}
        self._owners: dict[int, set[int]] = {}
        self._seen: set[int] = set()
        self._free: list[int] = []
        """Places of empty meshes, as a heap."""
        self._tried: dict[int, set[str]] = {}
        self._keys: dict[int, int] = {}
        self._before: dict[int, Mesh] = {}
        """By owner, what was forgotten and may come again with other positions."""
        self._unfinished: dict[int, tuple[int, dict[Hashable, Any]]] = {}
        """Owner, and what slices before have read of a mesh."""

    def begin_pass(self) -> None:
        """All uses of meshes follow."""
        self._seen = set()

    def end_pass(self) -> None:
        """Meshes that were not used since begin_pass are forgotten."""
        for key in self._places.keys() - self._seen:
            self._drop(key)
        self._before = {}
        self._unfinished = {}

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
        """Forget the meshes that these objects showed, because they have changed."""
        self._before = {}
        for key in [key for key, known in self._owners.items() if known & owners] if owners else ():
            place = self._places[key]
            if place is not None:
                self._before.update(dict.fromkeys(self._owners[key], self.meshes[place]))
            self._drop(key)
        for key in [key for key, (owner, _) in self._unfinished.items() if owner in owners]:
            del self._unfinished[key]

    def _drop(self, key: int) -> None:
        place = self._places.pop(key)
        self._unfinished.pop(key, None)
        self._owners.pop(key)
        self._seen.discard(key)
        if place is not None:
            self.meshes[place] = NO_MESH
            heapq.heappush(self._free, place)
            self._tried.pop(place)
            self._keys.pop(place)
            self.rings.pop(place, None)

    def index(
        self,
        source: bpy.types.Object,
        mesh: bpy.types.Mesh | RoundSource | GridSource | None,
        attributes: set[str],
        owner: int,
    ) -> int | None:
        """Index of a mesh, exported now if it is new, with the named attributes; None when it has no triangles.

        source: an evaluated object, never one that Blender's iterator makes up for an instance. mesh: None lets Blender
        make one of the object. owner: the session_uid of the object that brings the mesh.
        """
        key = (source if mesh is None else mesh).as_pointer()
        # What multiplies an object may bring the mesh that the object itself had before.
        bringers = owner, source.original.session_uid
        if key in self._places and key not in self._seen and self._owners[key].isdisjoint(bringers):
            self._drop(key)
        place = self._places.get(key)
        if key not in self._places or (place is not None and not attributes <= self._tried[place]):
            # What is made for the moment is read at once.
            bases = self._context.base_meshes
            if bases is not None and key not in self._places and bases.renew(source, owner != bringers[1]):
                self._unfinished.pop(key, None)  # it was of another mesh
            slices = Slices() if is_made_anew(source, mesh, bases) else self._report.slices
            with _read_of(source, mesh, bases) as evaluated:
                if key not in self._places:
                    self._add(source, evaluated, key, owner, slices)
                place = self._places[key]
                if place is not None:
                    self._complete(place, evaluated, attributes, owner, slices)
            self._before.pop(owner, None)
            self._unfinished.pop(key, None)
            self._owners[key].add(owner)
            slices.rest()
        self._seen.add(key)
        self._owners[key].add(owner)
        return place

    def _record(self, key: int, owner: int) -> dict[Hashable, Any]:
        """Return the record of what earlier slices have read of a mesh that an object brings."""
        if key not in self._unfinished or self._unfinished[key][0] != owner:
            self._unfinished[key] = owner, {}
        return self._unfinished[key][1]

    def _add(
        self,
        source: bpy.types.Object,
        mesh: bpy.types.Mesh | RoundSource | GridSource | None,
        key: int,
        owner: int,
        slices: Slices,
    ) -> None:
        self._report.progress(f"Exporting {source.name}")
        exported, name, record = None, source.name, self._record(key, owner)
        if mesh is not None:
            before = self._before.get(owner)
            with self._report.about(("mesh", owner, name, type(mesh).__name__)):
                if isinstance(mesh, bpy.types.Mesh):
                    exported = export_mesh(mesh, name, self._report, before, slices, record)
                elif isinstance(mesh, GridSource):
                    exported = export_grids(mesh, name, self._report, before, self._context.velocity_blur)
                else:
                    exported = export_round(mesh, name, self._context.curves, self._report, before, slices, record)
        self._owners[key] = {owner}
        self._seen.add(key)
        if exported is None:
            self._places[key] = None
            return
        place = self._places[key] = heapq.heappop(self._free) if self._free else len(self.meshes)
        bases = self._context.base_meshes
        if bases is not None and exported.shape is MeshShape.SURFACE and exported.volume is None:
            exported.dicing = bases.dicing(source)
        self.meshes[place : place + 1] = [exported]
        self._tried[place] = set()
        self._keys[place] = key
        if "rings" in record:
            self.rings[place] = record["rings"]

    def _complete(
        self,
        place: int,
        mesh: bpy.types.Mesh | RoundSource | GridSource,
        attributes: set[str],
        owner: int,
        slices: Slices,
    ) -> None:
        """Read attributes that were not asked for before; meshes that were handed out stay as they are."""
        if isinstance(mesh, GridSource):  # which has all of its grids
            self._tried[place] |= attributes
            return
        known, before = self.meshes[place], self._before.get(owner)
        found, record = dict(known.attributes), self._record(self._keys[place], owner)
        for name in sorted(attributes - known.attributes.keys()):
            if isinstance(mesh, bpy.types.Mesh):
                attribute = export_attribute(known, mesh, name, slices, record)
            else:
                attribute = export_round_attribute(mesh, name, self._context.curves, slices, record)
            if attribute is not None:
                old = None if before is None else before.attributes.get(name)
                found[name] = old if old is not None and equal(old, attribute) else attribute
        self.meshes[place] = dataclasses.replace(known, attributes=found)
        self._tried[place] |= attributes


@contextlib.contextmanager
def _read_of(
    source: bpy.types.Object,
    mesh: bpy.types.Mesh | RoundSource | GridSource | None,
    bases: BaseMeshes | None,
) -> Iterator[bpy.types.Mesh | RoundSource | GridSource | None]:
    """The data to be read of an object: those given, or else a mesh that Blender makes of it; None without one."""
    if mesh is None or isinstance(mesh, bpy.types.Mesh):
        with rendered_mesh(source, mesh, bases) as rendered:
            yield rendered
    else:
        yield mesh
