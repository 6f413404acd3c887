# SPDX-License-Identifier: GPL-3.0-or-later
"""Curves, texts, surfaces and metaballs, which are rendered as the mesh that Blender makes of them."""

from dataclasses import dataclass

import bpy
import numpy as np

from ....scene import Particle
from ..common.slices import Slices
from ..omissions import objects_of
from .instance_description import InstanceDescription
from .instance_reader import InstanceReader
from .placements import Identity, Placements


@dataclass(frozen=True)
class _Curve:
    """A placement of an object of which Blender may not have shown a mesh."""

    address: int
    """Address of the original object."""
    description: InstanceDescription
    matrix: np.ndarray
    random: float | None
    particle: Particle | None
    identity: Identity


class ConvertedCurves:
    """Places the curves, texts, surfaces and metaballs whose mesh did not come as an instance.

    Blender shows the mesh of such an object as an instance beside it, but not where particles or faces multiply the
    object.
    """

    def __init__(self, reader: InstanceReader, placements: Placements) -> None:
        self._reader = reader
        self._placements = placements
        self._curves: list[_Curve] = []
        self._shown: set[tuple[int, bytes]] = set()
        """Addresses of original objects and the matrices at which their meshes came as instances."""

    def add_mesh(self, original: int, matrix: np.ndarray) -> None:
        """Record that the mesh of an original object, by its address, came as an instance at a matrix (4, 4)."""
        self._shown.add((original, matrix.tobytes()))

    def add(
        self,
        source: bpy.types.Object,
        description: InstanceDescription,
        matrix: np.ndarray,
        identity: Identity,
        random: float | None = None,
        particle: Particle | None = None,
    ) -> None:
        """Record an object that is placed by a matrix (4, 4), unless its mesh comes there as well."""
        self._curves.append(_Curve(source.original.as_pointer(), description, matrix, random, particle, identity))

    def export(self, depsgraph: bpy.types.Depsgraph, slices: Slices) -> None:
        """Have Blender make the meshes that did not come. Raises Unfinished when the slice is over."""
        if not self._curves:
            return
        sources = {source.original.as_pointer(): source for source in objects_of(depsgraph)}
        while self._curves:
            curve = self._curves[0]
            if (curve.address, curve.matrix.tobytes()) not in self._shown:
                description = self._reader.convert(sources[curve.address], curve.description)
                if description is not None:
                    instance = description.place(curve.matrix, curve.random, curve.particle)
                    self._placements.add(instance, curve.matrix, 0, curve.identity)
            del self._curves[0]
            slices.rest()
