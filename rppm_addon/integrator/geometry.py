# SPDX-License-Identifier: GPL-3.0-or-later
"""Indexed arrays to world-space triangles, gathered on the GPU."""

import logging
from dataclasses import dataclass

import numpy as np

from ..gl.buffers import GrowingBuffer
from ..gl.context import Context
from ..gl.programs import ProgramLibrary
from ..gl.records import Record
from ..scene.meshes import Instance, Mesh, RayVisibility
from ..scene.scene import Scene
from ..scene.sharing import same_members
from .records import TRIANGLE_ATTRIBUTES

log = logging.getLogger(__name__)

_NO_UV = 0xFFFFFFFF

INSTANCE_ENTRY = Record(
    "InstanceEntry",
    row0="vec4",
    row1="vec4",
    row2="vec4",
    first_triangle="uint",
    mesh_triangle="uint",
    mesh_corner="uint",
    mesh_vertex="uint",
    mesh_uv="uint",
    first_slot="uint",
    slot_count="uint",
    shadowless="uint",
)
Record("GatherParameters", fallback_point="vec3", triangle_count="uint", instance_count="uint")


def finite_bounds(positions: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
    """Lowest and highest finite coordinates of points (..., 3), each (3,); None without any."""
    positions = positions.reshape(-1, 3)
    lowest, highest = positions.min(axis=0, initial=np.inf), positions.max(axis=0, initial=-np.inf)
    if not np.isfinite([lowest, highest]).all():
        finite = positions[np.isfinite(positions).all(axis=1)]
        if not len(finite):
            return None
        lowest, highest = finite.min(axis=0), finite.max(axis=0)
    return lowest.astype(np.float64), highest.astype(np.float64)


def box_corners(low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """(3, 8) corners of a box."""
    return np.array(np.meshgrid(*zip(low, high, strict=True))).reshape(3, -1)


def fits(corners: np.ndarray) -> np.ndarray:
    """Whether boxes (..., 3, 8) are finite and not too far away for their triangles to be rendered."""
    return (np.abs(corners) < 1e15).all(axis=(-2, -1))  # false for NaN as well


@dataclass
class Placement:
    """An instance, its first world triangle, and its world bounds in metres (maybe not finite)."""

    instance: Instance
    first_triangle: int
    low: np.ndarray
    high: np.ndarray


class Geometry:
    """World-space triangles of a scene in GPU buffers.

    ``triangles`` holds three vec4 a triangle (for the fourth components see shaders/geometry/gather.comp),
    ``attributes`` a TriangleAttributes each;
    ``placements`` lists the instances that have triangles; ``bounds_low`` and
    ``bounds_high`` (3,) enclose them, metres.
    """

    def __init__(self, context: Context, library: ProgramLibrary) -> None:
        remedy = "lower the subdivision, decimate meshes or remove instances"
        self._context = context
        self._gather = library.compute("geometry/gather.comp")
        self._inputs = {
            name: GrowingBuffer(context, f"geometry {name}", remedy)
            for name in (
                "Instances",
                "Positions",
                "CornerVertices",
                "CornerNormals",
                "CornerUvs",
                "TriangleCorners",
                "TriangleSlots",
                "SlotMaterials",
            )
        }
        self.triangles = GrowingBuffer(context, "world triangles", remedy)
        self.attributes = GrowingBuffer(context, "triangle attributes", remedy)
        self._meshes: list[Mesh] = []
        self._mesh_bounds: list[tuple[np.ndarray, np.ndarray] | None] = []
        self.triangle_count = 0
        self.placements: list[Placement] = []
        self.bounds_low = self.bounds_high = np.zeros(3)

    @property
    def centre(self) -> np.ndarray:
        """Centre of the bounding sphere, (3,) metres."""
        return 0.5 * (self.bounds_low + self.bounds_high)

    @property
    def radius(self) -> float:
        """Radius of the bounding sphere of the bounds, metres; never zero."""
        return max(0.5 * float(np.linalg.norm(self.bounds_high - self.bounds_low)), 1e-9)

    @property
    def memory_bytes(self) -> dict[str, int]:
        buffers = [*self._inputs.values(), self.triangles, self.attributes]
        return {buffer.name: buffer.size for buffer in buffers}

    def build(
        self, scene: Scene, default_material: int, swept: tuple[np.ndarray, np.ndarray] | None = None
    ) -> None:
        """Upload the meshes and gather all instances. ``default_material`` serves empty slots. ``swept``: what the
        bounds enclose in any case, each (3,), low and high.

        Meshes that are the very objects of the last build are not uploaded again: moving instances
        uploads the instances only. Whoever changes a mesh gives a new one.
        Raises DeviceError when the device cannot hold them.
        """
        used = sorted({instance.mesh for instance in scene.instances})
        meshes = [scene.meshes[index] for index in used]
        place = {index: position for position, index in enumerate(used)}
        unchanged = same_members(meshes, self._meshes)
        bounds = self._mesh_bounds if unchanged else [finite_bounds(mesh.positions) for mesh in meshes]

        def starts(lengths: list[int]) -> np.ndarray:
            return np.concatenate([[0], np.cumsum(lengths)]).astype(np.int64)

        vertex_start = starts([len(mesh.positions) for mesh in meshes])
        corner_start = starts([len(mesh.corner_vertices) for mesh in meshes])
        triangle_start = starts([mesh.triangle_count for mesh in meshes])
        uv_start = starts([0 if mesh.corner_uv is None else len(mesh.corner_uv) for mesh in meshes])

        instances = [
            i for i in scene.instances if bounds[place[i.mesh]] is not None and scene.meshes[i.mesh].triangle_count
        ]
        entries = INSTANCE_ENTRY.zeros(len(instances))
        slots: list[int] = []
        placements: list[Placement] = []
        low, high = np.full(3, np.inf), np.full(3, -np.inf)
        first = 0
        for entry, instance in zip(entries, instances, strict=True):
            mesh = place[instance.mesh]
            entry["row0"], entry["row1"], entry["row2"] = instance.matrix[:3]
            entry["first_triangle"], entry["mesh_triangle"] = first, triangle_start[mesh]
            entry["mesh_corner"], entry["mesh_vertex"] = corner_start[mesh], vertex_start[mesh]
            entry["mesh_uv"] = _NO_UV if meshes[mesh].corner_uv is None else uv_start[mesh]
            materials = [m if 0 <= m < len(scene.materials) else default_material for m in instance.materials]
            entry["first_slot"], entry["slot_count"] = len(slots), max(1, len(materials))
            slots.extend(materials or [default_material])
            entry["shadowless"] = not instance.visibility & RayVisibility.SHADOW
            first += meshes[mesh].triangle_count
            world = instance.matrix[:3, :3] @ box_corners(*bounds[mesh]) + instance.matrix[:3, 3:]
            placements.append(Placement(instance, int(entry["first_triangle"]), world.min(axis=1), world.max(axis=1)))
            if fits(world):
                low, high = np.minimum(low, world.min(axis=1)), np.maximum(high, world.max(axis=1))
            else:
                log.warning(
                    "object %s has a matrix that is not finite; its triangles are left out", instance.object_name
                )
        self.triangle_count = first
        self.placements = placements
        if swept is not None:
            low, high = np.minimum(low, swept[0]), np.maximum(high, swept[1])
        if not np.isfinite(low).all():
            low = high = np.zeros(3)
        self.bounds_low, self.bounds_high = low, high

        def joined(arrays: list[np.ndarray], dtype: type) -> np.ndarray:
            return (
                np.concatenate([a.reshape(-1).astype(dtype, copy=False) for a in arrays])
                if arrays
                else np.zeros(1, dtype)
            )

        uploads = {
            "Instances": entries,
            "SlotMaterials": np.array(slots or [default_material], np.uint32),
        }
        if not unchanged:
            uploads |= {
                "Positions": joined([m.positions for m in meshes], np.float32),
                "CornerVertices": joined([m.corner_vertices for m in meshes], np.uint32),
                "CornerNormals": joined([m.corner_normals for m in meshes], np.float32),
                "CornerUvs": joined([m.corner_uv for m in meshes if m.corner_uv is not None], np.float32),
                "TriangleCorners": joined([m.triangle_corners for m in meshes], np.uint32),
                "TriangleSlots": joined([m.triangle_slots for m in meshes], np.uint32),
            }
        self._meshes = []  # should an upload fail
        for name, array in uploads.items():
            self._inputs[name].upload(array)
        self._meshes, self._mesh_bounds = meshes, bounds
        self.triangles.require(48 * max(1, self.triangle_count))
        self.attributes.require(TRIANGLE_ATTRIBUTES.size * max(1, self.triangle_count))
        buffers = {name: buffer.buffer for name, buffer in self._inputs.items()}
        buffers |= {"Triangles": self.triangles.buffer, "Attributes": self.attributes.buffer}
        self._gather.run(
            self.triangle_count,
            buffers,
            {"fallback_point": self.centre, "triangle_count": self.triangle_count, "instance_count": len(instances)},
        )

    def release(self) -> None:
        for buffer in [*self._inputs.values(), self.triangles, self.attributes]:
            buffer.release()
