# SPDX-License-Identifier: GPL-3.0-or-later
"""Object data that shading nodes read: matrices, object and particle info, mesh attributes."""

import operator

import numpy as np

from ...gl.buffer_sets import BufferSet, StorageBuffer
from ...gl.buffers.constants import Constants
from ...gl.buffers.records import Record
from ...gl.buffers.storage_blocks import StorageBlock
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ...scene.light_linking import ALL_SETS
from ...scene.meshes import AttributeDomain, Instance, Mesh, MeshAttribute, MeshShape
from ...scene.scene import Scene
from ...scene.storage.sharing import same_members
from ..acceleration.instance_records import runs
from ..common.affine import affine_inverses
from ..common.records.closures import TERMINATOR_SHIFT, TERMINATOR_STEPS
from .geometry import Geometry
from .placements import PlacedArrays

SHADING_INSTANCE = Record(
    "ShadingInstance",
    to_object0="vec4",
    to_object1="vec4",
    to_object2="vec4",
    color="vec4",
    location="vec3",
    random="float",
    object_index="uint",
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
    terminator_offset="float",
    particle_velocity="vec3",
    light_sets0="uint",
    particle_angular_velocity="vec3",
    light_sets1="uint",
    terminator_flags="uint",
    shape="uint",
)
"""An instance as nodes see it: the rows of its world-to-object matrix, and the values of Object Info and Particle Info;
the words of the bits of the light sets that it shines on; and of its shadow terminator the geometry offset and what the
flags of its closures say; ``shape``: of its mesh (MeshShapes)."""
SPHERE_REACHES = [1.14563412, 1.03787541, 1.00954588, 1.00239101]
"""By how often an icosahedron is subdivided, how far from the middle its vertices lie where it has the area of the unit
sphere, as those of points have it."""
Constants(
    "MeshShapes",
    SHAPE={shape.name: number for number, shape in enumerate(MeshShape)},
    SPHERE_REACHES=SPHERE_REACHES,
)

StorageBlock("ShadingInstances", "ShadingInstance shading_instances[];")

_SHAPES = {shape: number for number, shape in enumerate(MeshShape)}
_AT_ONCE = 1 << 16
"""Records that are filled in at a time, lest those of a million stand in memory at once."""
_PARTICLE = ("index", "random", "age", "lifetime", "size", "location", "velocity", "angular_velocity")


class SurfaceAttributes(BufferSet):
    """The buffers ShadingInstances and AttributeValues: the latter starts with the place and the components of each of
    ``count`` attributes of each instance, then come the values, three corners a triangle."""

    _instances = StorageBuffer(
        "shading instances", SHADING_INSTANCE, remedy="remove instances", texel_bytes=16, block="ShadingInstances"
    )
    _values = StorageBuffer(
        "mesh attributes", "uint", remedy="use fewer attributes in materials", texel_bytes=16, block="AttributeValues"
    )

    def __init__(self, context: Context, library: ProgramLibrary, sizes: object = None) -> None:
        super().__init__(context, library, sizes)
        self.count = 0
        self.has_terminators = False
        """Whether any instance has an offset of its shadow terminator."""
        self._have_terminators = np.zeros(0, bool)
        """(instances,) those that have one."""
        self._meshes: list[Mesh] = []
        """Meshes of the records on the device."""
        self._version = -1
        """PlacedArrays.version of these; below all where they are not known."""
        self._sources: dict[int, tuple] = {}
        """Arrays and settings from which the values were made, by the place of these in the buffer."""

    def build(self, scene: Scene, geometry: Geometry, names: list[str]) -> None:
        """Upload what the nodes of the scene's materials need. ``names``: the attributes that they read.

        Values that come from the very arrays of the last build and have the same place are not written again.
        """
        self.count = len(names)
        instances = geometry.placements.instances
        self._write_records(scene.meshes, instances, geometry.placed)
        turned = (geometry.placed.determinants < 0.0).tolist() if names else []
        self._upload_values(scene.meshes, instances, turned, names)

    def _write_records(self, meshes: list[Mesh], instances: list[Instance], placed: PlacedArrays) -> None:
        """Write the records of the instances whose rows are not as they were the last time."""
        before, self._version = self._version, -1  # should an upload fail
        if self._instances.require_items(max(1, len(instances))) or not same_members(meshes, self._meshes):
            before = -1  # a record has the box of a mesh as well
        rows = np.flatnonzero(placed.versions > before)
        if len(rows) == len(instances):
            self._have_terminators = np.zeros(len(instances), bool)
        for part in runs(rows, _AT_ONCE):
            records = SHADING_INSTANCE.zeros(len(part))
            chosen = slice(int(part[0]), int(part[-1]) + 1)
            _fill(records, instances[chosen], placed.matrices[chosen], meshes)
            self._have_terminators[chosen] = (records["terminator_offset"] > 0) | (records["terminator_flags"] > 0)
            self._instances.write(records, int(part[0]) * SHADING_INSTANCE.size)
        if not instances:
            self._instances.write(SHADING_INSTANCE.zeros(1))
        self.has_terminators = bool(self._have_terminators.any())
        self._meshes, self._version = list(meshes), placed.version

    def _upload_values(
        self, meshes: list[Mesh], instances: list[Instance], turned: list[bool], names: list[str]
    ) -> None:
        table = np.zeros((len(instances), self.count, 2), np.uint32)
        places: dict[tuple, tuple[int, int]] = {}
        values: dict[int, tuple[MeshAttribute, Mesh, bool]] = {}
        end = table.size
        for number, name in enumerate(names if instances else ()):
            column = []
            for instance, is_turned in zip(instances, turned, strict=True):
                own = instance.attributes.get(name) if instance.attributes else None
                key = (instance.mesh, name, is_turned) if own is None else (name, *own)
                if key not in places:
                    mesh = meshes[instance.mesh]
                    attribute = mesh.attributes.get(name) if own is None else _constant(own, mesh)
                    places[key] = (0, 0)
                    if attribute is not None and mesh.triangle_count:
                        places[key] = (end, attribute.values.shape[1])
                        values[end] = attribute, mesh, is_turned
                        end += 3 * mesh.triangle_count * attribute.values.shape[1]
                column.append(places[key])
            table[:, number] = column
        before, self._sources = self._sources, {}  # should an upload fail
        if self._values.require_items(end):
            before = {}
        self._values.write(table)
        sources = {}
        for place, (attribute, mesh, is_turned) in values.items():
            sources[place] = attribute.domain, attribute.values, mesh.triangle_corners, mesh.corner_vertices, is_turned
            if not same_members(sources[place], before.get(place, ())):
                self._values.write(_per_corner(attribute, mesh, is_turned), 4 * place)
        self._sources = sources


def _fill(records: np.ndarray, instances: list[Instance], matrices: np.ndarray, meshes: list[Mesh]) -> None:
    """Fill in records of instances, whose matrices (n, 4, 4) are these."""
    which = np.array([instance.mesh for instance in instances])
    used = np.unique(which)
    place = np.searchsorted(used, which)
    size = np.array([meshes[index].texture_size for index in used], np.float64)
    records["texture_location"] = np.array([meshes[index].texture_location for index in used])[place]
    records["shape"] = np.array([_SHAPES[meshes[index].shape] for index in used])[place]
    records["texture_scale"] = np.where(size != 0.0, 0.5 / np.where(size != 0.0, size, 1.0), 0.0)[place]
    with np.errstate(invalid="ignore", over="ignore"):
        inverses = affine_inverses(matrices)
    for row in range(3):
        records[f"to_object{row}"] = inverses[:, row]
    records["location"] = matrices[:, :3, 3]
    for name in ("color", "random", "object_index", "holdout", "shadow_catcher"):
        records[name] = _column(instances, name)
    records["visibility"] = [int(instance.visibility) for instance in instances]
    memberships = np.array([_light_sets(instance) for instance in instances], np.int64).view(np.uint64)
    records["light_sets0"], records["light_sets1"] = memberships & 0xFFFFFFFF, memberships >> np.uint64(32)
    geometry, shading = (_column(instances, f"terminator_{name}_offset") for name in ("geometry", "shading"))
    records["terminator_offset"] = geometry
    steps = np.round(TERMINATOR_STEPS * np.clip(shading, 0.0, 1.0)).astype(np.uint32)
    records["terminator_flags"] = steps << np.uint32(TERMINATOR_SHIFT)
    multiplied = np.flatnonzero([instance.particle is not None for instance in instances])
    particles = [instances[index].particle for index in multiplied]
    for name in _PARTICLE if particles else ():
        records[f"particle_{name}"][multiplied] = _column(particles, name)


def _light_sets(instance: Instance) -> int:
    return ALL_SETS if instance.linking is None else instance.linking.light_set_membership


def _column(members: list, name: str) -> np.ndarray:
    # First an array: records take lists of tuples tuple by tuple.
    return np.array(list(map(operator.attrgetter(name), members)))


def object_record(matrix: np.ndarray) -> np.ndarray:
    """() SHADING_INSTANCE of an object without a mesh, whose generated coordinates are those of the object."""
    record = SHADING_INSTANCE.zeros(1)[0]
    (inverse,) = affine_inverses(np.asarray(matrix, np.float64)[None])
    record["to_object0"], record["to_object1"], record["to_object2"] = inverse
    record["location"] = matrix[:3, 3]
    record["texture_location"], record["texture_scale"] = 0.5, 1.0
    record["color"] = 1.0
    return record


def _constant(value: tuple[float, ...], mesh: Mesh) -> MeshAttribute:
    """Return an attribute that has the same value on all triangles of a mesh."""
    values = np.tile(np.array(value, np.float32), (mesh.triangle_count, 1))
    return MeshAttribute(AttributeDomain.TRIANGLE, values)


def _per_corner(attribute: MeshAttribute, mesh: Mesh, is_turned: bool) -> np.ndarray:
    """(3 * triangles, components) float32 values at the triangles' corners, as their world triangles have these."""
    corners = (mesh.triangle_corners[:, [0, 2, 1]] if is_turned else mesh.triangle_corners).reshape(-1)
    values = np.ascontiguousarray(attribute.values, np.float32)
    if attribute.domain is AttributeDomain.CORNER:
        return values.take(corners, axis=0)
    if attribute.domain is AttributeDomain.POINT:
        return values.take(mesh.corner_vertices.take(corners), axis=0)
    return np.repeat(values, 3, axis=0)
