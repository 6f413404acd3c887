# SPDX-License-Identifier: GPL-3.0-or-later
"""What shading nodes ask about objects: matrices, object and particle info, mesh attributes."""

import numpy as np

from ..gl.buffers import GrowingBuffer
from ..gl.context import Context
from ..gl.records import Record
from ..scene.meshes import AttributeDomain, Instance, Mesh, MeshAttribute
from ..scene.scene import Scene
from .geometry import Geometry

SHADING_INSTANCE = Record(
    "ShadingInstance",
    to_object0="vec4",
    to_object1="vec4",
    to_object2="vec4",
    color="vec4",
    location="vec3",
    random="float",
    object_index="uint",
    first_triangle="uint",
    particle_index="float",
    particle_random="float",
    particle_age="float",
    particle_lifetime="float",
    particle_size="float",
    visibility="uint",
    texture_location="vec3",
    holdout="uint",
    texture_scale="vec3",
    shadow_catcher="uint",
    particle_location="vec3",
    unused1="float",
    particle_velocity="vec3",
    unused2="float",
    particle_angular_velocity="vec3",
    unused3="float",
)
"""An instance as nodes see it: the rows of its world-to-object matrix, and what Object Info and Particle Info tell."""


class SurfaceAttributes:
    """The buffers ShadingInstances and AttributeValues: the latter starts with the place and the components of each of
    ``count`` attributes of each instance, then come the values, three corners a triangle."""

    def __init__(self, context: Context) -> None:
        self._instances = GrowingBuffer(context, "shading instances", "remove instances")
        self._values = GrowingBuffer(context, "mesh attributes", "use fewer attributes in materials")
        self.count = 0

    @property
    def buffers(self) -> dict:
        return {"ShadingInstances": self._instances.buffer, "AttributeValues": self._values.buffer}

    @property
    def memory_bytes(self) -> dict[str, int]:
        return {buffer.name: buffer.size for buffer in (self._instances, self._values)}

    def build(self, scene: Scene, geometry: Geometry, names: list[str]) -> None:
        """Upload what the nodes of the scene's materials need. ``names``: the attributes that they read."""
        self.count = len(names)
        records = SHADING_INSTANCE.zeros(max(1, len(geometry.placements)))
        table = np.zeros((len(geometry.placements), self.count, 2), np.uint32)
        values: list[np.ndarray] = []
        known: dict[tuple, tuple[int, int]] = {}
        end = table.size
        for index, placement in enumerate(geometry.placements):
            instance = placement.instance
            mesh = scene.meshes[instance.mesh]
            _fill(records[index], instance, mesh, placement.first_triangle)
            for number, name in enumerate(names):
                own = instance.attributes.get(name)
                key = (instance.mesh, name) if own is None else (name, *own)
                if key not in known:
                    array = _per_corner(mesh, name) if own is None else np.tile(own, (3 * mesh.triangle_count, 1))
                    known[key] = (0, 0)
                    if array is not None and array.size:
                        known[key] = (end, array.shape[1])
                        values.append(np.ascontiguousarray(array, np.float32).view(np.uint32).ravel())
                        end += array.size
                table[index, number] = known[key]
        self._instances.upload(records)
        self._values.upload(np.concatenate([table.ravel(), *values]) if end else np.zeros(1, np.uint32))

    def release(self) -> None:
        self._instances.release()
        self._values.release()


def _fill(record: np.ndarray, instance: Instance, mesh: Mesh, first_triangle: int) -> None:
    size = np.asarray(mesh.texture_size, np.float64)
    record["texture_location"] = mesh.texture_location
    record["texture_scale"] = np.where(size != 0.0, 0.5 / np.where(size != 0.0, size, 1.0), 0.0)
    rows = _inverse(instance.matrix)
    record["to_object0"], record["to_object1"], record["to_object2"] = rows[:3]
    record["location"] = instance.matrix[:3, 3]
    record["color"], record["random"] = instance.color, instance.random
    record["object_index"], record["first_triangle"] = instance.object_index, first_triangle
    record["visibility"], record["holdout"] = int(instance.visibility), instance.holdout
    record["shadow_catcher"] = instance.shadow_catcher
    particle = instance.particle
    if particle is not None:
        for name in ("index", "random", "age", "lifetime", "size", "location", "velocity", "angular_velocity"):
            record[f"particle_{name}"] = getattr(particle, name)


def object_record(matrix: np.ndarray) -> np.ndarray:
    """() SHADING_INSTANCE of an object without a mesh, whose generated coordinates are those of the object."""
    record = SHADING_INSTANCE.zeros(1)[0]
    rows = _inverse(np.asarray(matrix, np.float64))
    record["to_object0"], record["to_object1"], record["to_object2"] = rows[:3]
    record["location"] = matrix[:3, 3]
    record["texture_location"], record["texture_scale"] = 0.5, 1.0
    record["color"] = 1.0
    return record


def _inverse(matrix: np.ndarray) -> np.ndarray:
    """(4, 4), all 0 where there is none, as for an instance without extent."""
    try:
        return np.linalg.inv(matrix)
    except np.linalg.LinAlgError:
        return np.zeros((4, 4))


def _per_corner(mesh: Mesh, name: str) -> np.ndarray | None:
    """(3 * triangles, components) values of an attribute at the triangles' corners; None when it is not there."""
    attribute: MeshAttribute | None = mesh.attributes.get(name)
    if attribute is None:
        return None
    corners = mesh.triangle_corners.reshape(-1)
    if attribute.domain is AttributeDomain.CORNER:
        return attribute.values[corners]
    if attribute.domain is AttributeDomain.POINT:
        return attribute.values[mesh.corner_vertices[corners]]
    return np.repeat(attribute.values, 3, axis=0)
