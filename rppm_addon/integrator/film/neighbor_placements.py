# SPDX-License-Identifier: GPL-3.0-or-later
"""Placements of a scene's instances in the frame before and in the next one."""

from collections.abc import Sequence

import numpy as np

from ...gl.buffer_sets import BufferSet, StorageBuffer
from ...gl.buffers.constants import Constants
from ...gl.buffers.records import Record
from ...gl.buffers.storage_blocks import StorageBlock
from ...scene.meshes import Mesh
from ...scene.motion import Shutter
from ...scene.scene import Scene
from ..surfaces.gather_inputs import array_starts, part_starts
from ..surfaces.geometry import Geometry, finite_bounds
from ..surfaces.placements import PlacedArrays
from ..surfaces.volume_insets import inset_matrix

NEIGHBOR_INSTANCE = Record(
    "NeighborInstance",
    row0="vec4",
    row1="vec4",
    row2="vec4",
    pivot="vec3",
    mesh_vertex="uint",
    mesh_triangle="uint",
    mesh_corner="uint",
    mirrored="uint",
)
"""An instance in a neighboring frame: ``row`` and ``pivot`` as those of InstanceEntry, and so are ``mesh_triangle`` and
``mesh_corner``. ``mesh_vertex``: where the positions of its mesh begin, counted in vertices. ``mirrored``: its
triangles are wound the other way round in the frame itself."""
StorageBlock("NeighborInstances", "NeighborInstance neighbor_instances[];")
"""Two for each instance that moves: of the frame before, and of the next one."""
StorageBlock("NeighborPlaces", "uint neighbor_places[];")
"""The first of its two neighbor instances, for each placement."""
StorageBlock("NeighborPositions", "float neighbor_positions[];")
_RESTS = 0xFFFFFFFF
Constants("NeighborPlaces", RESTS=_RESTS)
"""In place of its neighbor instances: the placement is where it was, and will be."""


class NeighborPlacements(BufferSet):
    """Placements in the frames before and after of those instances that move or bend, and the positions of their
    meshes there. What rests takes 4 bytes an instance."""

    remedy = "switch off the pass Vector"
    _places = StorageBuffer("movements of instances", "uint", texel_bytes=16, block="NeighborPlaces")
    _instances = StorageBuffer(
        "instances of the frames before and after", NEIGHBOR_INSTANCE, texel_bytes=16, block="NeighborInstances"
    )
    _positions = StorageBuffer(
        "positions of the frames before and after", "float", texel_bytes=16, block="NeighborPositions"
    )

    def take(self, geometry: Geometry, neighbors: Shutter, scenes: Sequence[Scene]) -> None:
        """Take the scenes of both frames, whose members are those of the scene that the geometry was built of.
        ``neighbors``: what moves between them. Raises DeviceError when the device cannot hold them."""
        rows = _moving_rows(geometry, neighbors)
        used, which = np.unique(geometry.columns.meshes[geometry.placed_meshes.chosen[rows]], return_inverse=True)
        meshes = [[scene.meshes[index] for index in used.tolist()] for scene in scenes]
        positions = {id(mesh.positions): mesh.positions for frame in meshes for mesh in frame}
        starts = dict(zip(positions, part_starts([len(array) for array in positions.values()]).tolist(), strict=False))
        records = NEIGHBOR_INSTANCE.zeros(2 * len(rows))
        for frame, scene in enumerate(scenes):
            part = records[frame::2]
            _place(part, geometry, rows, scene, meshes[frame], which)
            part["mesh_vertex"] = np.array([starts[id(mesh.positions)] for mesh in meshes[frame]], np.uint32)[which]
        places = np.full(len(geometry.placements), _RESTS, np.uint32)
        places[rows] = 2 * np.arange(len(rows))
        self._places.upload(places)
        self._instances.upload(records)
        arrays = [np.asarray(array, np.float32).reshape(-1) for array in positions.values()]
        self._positions.upload(np.concatenate(arrays) if arrays else np.zeros(0, np.float32))


def _moving_rows(geometry: Geometry, neighbors: Shutter) -> np.ndarray:
    """(k,) int64, ascending, the placements that move or whose mesh bends."""
    moves = np.isin(geometry.columns.meshes, [deformation.mesh for deformation in neighbors.meshes])
    moves[[movement.member for movement in neighbors.instances]] = True
    return np.flatnonzero(moves[geometry.placed_meshes.chosen])


def _place(
    records: np.ndarray, geometry: Geometry, rows: np.ndarray, scene: Scene, meshes: list[Mesh], which: np.ndarray
) -> None:
    """Fill in all of NEIGHBOR_INSTANCE records (k,) but where positions begin. ``rows``: (k,) their placements;
    ``meshes``: those of the scene of a frame, ``which``: (k,) the one of each."""
    if not len(rows):
        return
    of = geometry.placed_meshes
    bounds = [finite_bounds(mesh.positions) for mesh in meshes]
    boxes = np.array([box or np.zeros((2, 3)) for box in bounds]).reshape(-1, 2, 3)
    matrices = np.array([scene.instances[member].matrix for member in of.chosen[rows].tolist()], np.float64)
    for number in np.flatnonzero(np.isin(rows, of.insets)).tolist():
        matrices[number] = inset_matrix(matrices[number], boxes[which[number]], int(rows[number]))
    placed = PlacedArrays()
    placed.take(matrices, boxes, which, of.has_pivots, None)
    for row in range(3):
        records[f"row{row}"] = placed.rows[:, row]
    records["pivot"] = placed.pivots
    starts = array_starts(of.meshes)
    for field in ("mesh_triangle", "mesh_corner"):
        records[field] = starts[field][of.which[rows]]
    records["mirrored"] = geometry.placed.determinants[rows] < 0.0
