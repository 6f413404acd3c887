# SPDX-License-Identifier: GPL-3.0-or-later
"""Inputs of gathering triangles: instances, their slots, and the arrays of all meshes one behind the other."""

from collections.abc import Sequence

import numpy as np

from ...gl.buffer_sets import BufferSet, StorageBuffer
from ...gl.buffers.constants import Constants
from ...gl.buffers.records import Record
from ...gl.buffers.storage_blocks import StorageBlock
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ...scene.meshes import Mesh

INSTANCE_ENTRY = Record(
    "InstanceEntry",
    row0="vec4",
    row1="vec4",
    row2="vec4",
    pivot="vec3",
    first_triangle="uint",
    mesh_triangle="uint",
    mesh_corner="uint",
    mesh_vertex="uint",
    mesh_uv="uint",
    first_slot="uint",
    slot_count="uint",
    set_code="float",
)
StorageBlock("Instances", "InstanceEntry instances[];")
StorageBlock("TriangleSlots", "uint triangle_slots[];")
StorageBlock("SlotMaterials", "uint slot_materials[];")
"""Slots of the triangles of meshes, and materials of the slots of instances, from InstanceEntry.first_slot on."""
StorageBlock("CornerNormals", "float corner_normals[];")
StorageBlock("CornerVertices", "uint corner_vertices[];")
StorageBlock("TriangleCorners", "uint triangle_corners[];")
"""Vertices of corners and corners of triangles, each counted from where those of the mesh begin."""
_STARTS = {
    "mesh_triangle": "triangle_corners",
    "mesh_corner": "corner_vertices",
    "mesh_vertex": "positions",
    "mesh_uv": "corner_uv",
}
"""Members of InstanceEntry that are where a mesh's part of such an array begins."""
_NO_UV = 0xFFFFFFFF
"""In place of where a mesh's UV begin."""
Constants("MeshArrays", NO_UV=_NO_UV)

_DTYPES = {
    "positions": np.dtype(np.float32),
    "corner_vertices": np.dtype(np.uint32),
    "corner_normals": np.dtype(np.float32),
    "corner_uv": np.dtype(np.float32),
    "triangle_corners": np.dtype(np.uint32),
    "triangle_slots": np.dtype(np.uint32),
}
"""Types in the buffers of arrays of meshes, by the member of Mesh and of GatherInputs."""


class GatherInputs(BufferSet):
    """Buffers that shaders/surfaces/geometry/gather.comp reads."""

    remedy = "lower the subdivision or the children of particles (Simplify does so for all), or decimate meshes"
    instances = StorageBuffer("geometry Instances", INSTANCE_ENTRY, texel_bytes=16, block="Instances")
    slot_materials = StorageBuffer("geometry SlotMaterials", "uint", texel_bytes=16, block="SlotMaterials")
    positions = StorageBuffer("geometry Positions", "float", texel_bytes=16, block="Positions")
    corner_vertices = StorageBuffer("geometry CornerVertices", "uint", texel_bytes=16, block="CornerVertices")
    corner_normals = StorageBuffer("geometry CornerNormals", "float", texel_bytes=16, block="CornerNormals")
    corner_uv = StorageBuffer("geometry CornerUvs", "vec2", texel_bytes=16, block="CornerUvs")
    triangle_corners = StorageBuffer("geometry TriangleCorners", "uint", texel_bytes=16, block="TriangleCorners")
    triangle_slots = StorageBuffer("geometry TriangleSlots", "uint", texel_bytes=16, block="TriangleSlots")

    def __init__(self, context: Context, library: ProgramLibrary) -> None:
        super().__init__(context, library)
        self._arrays: dict[str, list[np.ndarray]] = {}
        """Arrays of all meshes as they were uploaded, by member."""

    def upload_meshes(self, meshes: list[Mesh]) -> None:
        """Write the arrays of meshes that are not the very objects of the last call at the same place.

        Arrays that follow each other are written together. Raises DeviceError when the device cannot hold them.
        """
        for member, dtype in _DTYPES.items():
            arrays = [array for mesh in meshes if (array := getattr(mesh, member)) is not None]
            before = self._arrays.pop(member, [])  # should an upload fail
            buffer = getattr(self, member)
            offsets = part_starts([array.size * dtype.itemsize for array in arrays])
            is_new = buffer.require(int(offsets[-1]))
            stands = not is_new and [a.shape for a in before] == [a.shape for a in arrays]
            changed = [index for index, array in enumerate(arrays) if not (stands and array is before[index])]
            for run in _runs(changed):
                data = [_flat(arrays[index], dtype) for index in run]
                buffer.write(data[0] if len(data) == 1 else np.concatenate(data), int(offsets[run[0]]))
            self._arrays[member] = arrays


def array_starts(meshes: list[Mesh]) -> dict[str, np.ndarray]:
    """(meshes,) int64 places where the arrays of each mesh begin, by the member of INSTANCE_ENTRY that says so."""
    return {
        field: part_starts([_length(getattr(mesh, member)) for mesh in meshes])[:-1]
        for field, member in _STARTS.items()
    }


def locate(entries: np.ndarray, meshes: list[Mesh], which: np.ndarray) -> None:
    """Fill in where the arrays of the mesh of each entry begin; which: (n,), the places of these among the meshes."""
    for field, starts in array_starts(meshes).items():
        entries[field] = starts[which]
    entries["mesh_uv"][np.array([mesh.corner_uv is None for mesh in meshes])[which]] = _NO_UV


def place_slots(
    entries: np.ndarray, numbers: np.ndarray, lists: Sequence[Sequence[int]], known: range, default_material: int
) -> np.ndarray:
    """Fill in the slots of entries; returns the materials of all slots, uint32, the same for instances alike.

    numbers: (n,) of the list of materials that the slots of each have, among ``lists``; those that are not among the
    ``known`` are the default material.
    """
    slots: list[int] = []
    ranges = np.zeros((len(lists), 2), np.uint32)
    for number in np.flatnonzero(np.bincount(numbers, minlength=len(lists))).tolist():
        key = lists[number]
        ranges[number] = len(slots), max(1, len(key))
        slots += [m if m in known else default_material for m in key] or [default_material]
    entries["first_slot"], entries["slot_count"] = ranges[:, 0][numbers], ranges[:, 1][numbers]
    return np.array(slots, np.uint32)


def part_starts(lengths: list[int]) -> np.ndarray:
    """(n + 1,) int64 places where parts of these lengths begin one behind the other, and their end."""
    return np.concatenate([[0], np.cumsum(lengths)]).astype(np.int64)


def _flat(array: np.ndarray, dtype: np.dtype) -> np.ndarray:
    """(n,) of the type in the buffer, without a copy where the bits are the same."""
    flat = np.ascontiguousarray(array).reshape(-1)
    if flat.dtype.kind in "iu" and flat.dtype.itemsize == dtype.itemsize and dtype.kind == "u":
        return flat.view(dtype)
    return flat.astype(dtype, copy=False)


def _runs(indices: list[int]) -> list[list[int]]:
    """Ascending numbers, those together that follow each other."""
    runs: list[list[int]] = []
    for index in indices:
        if runs and runs[-1][-1] + 1 == index:
            runs[-1].append(index)
        else:
            runs.append([index])
    return runs


def _length(array: np.ndarray | None) -> int:
    return 0 if array is None else len(array)
