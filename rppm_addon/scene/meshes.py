# SPDX-License-Identifier: GPL-3.0-or-later
"""Indexed geometry and its placements."""

import dataclasses
import enum
import weakref
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from .camera import Camera
from .common.declared import declared
from .light_linking import LightLinking
from .volumes import Volume

SMOOTH_NORMALS = ".smooth_normals"
"""Name of the attribute by which meshes that are displaced mark faces that are not smooth: of corners, the normal
along which vertices move, and 1 where the face is smooth, 0 where it is flat. Without it all faces are smooth."""
UNDISPLACED = ".undisplaced"
"""Name of the attribute that has the positions of vertices before they were displaced, object space."""


class AttributeDomain(enum.Enum):
    """Kind of mesh element; an attribute has a value for each element of its kind."""

    POINT = "point"
    CORNER = "corner"
    TRIANGLE = "triangle"


@dataclass
class MeshAttribute:
    """Values over a mesh that shading nodes may read."""

    domain: AttributeDomain
    values: np.ndarray = field(metadata=declared("elements", "channels", types="float32", finite=False))
    """(elements of the domain, 1 to 4) float32; colors are linear Rec.709."""


@dataclass(frozen=True)
class Dicing:
    """Fineness to which a mesh is divided before it is rendered (Adaptive Subdivision)."""

    edge_length: float = field(metadata=declared(minimum=1e-6))
    """Length of edges: in pixels, or in meters of object space; DicingView.rate multiplies it."""
    in_pixels: bool
    is_curved: bool
    """True where faces bend by their normals as they are divided; else they stay flat."""
    base_level: int = field(default=0, metadata=declared(minimum=0))
    """Number of times that the edges of the mesh have been halved already."""


@dataclass(frozen=True, eq=False)
class DicingView:
    """View by which a scene divides those of its meshes that have a Dicing."""

    rate: float = field(default=1.0, metadata=declared(minimum=1e-6))
    """Factor on Dicing.edge_length."""
    offscreen_scale: float = field(default=4.0, metadata=declared(minimum=1.0))
    """Factor that says how much longer edges outside of the picture may be, the farther they are from it."""
    max_subdivisions: int = field(default=12, metadata=declared(minimum=0))
    """Number of times that edges are halved at most, those of Dicing.base_level included."""
    camera: Camera | None = None
    """Camera that sees the edges; None is the scene's."""


class MeshShape(enum.Enum):
    """Shape that the triangles of a mesh stand for."""

    SURFACE = "surface"
    """Themselves."""
    STRANDS = "strands"
    """Round strands: tubes (blender/export/geometry/strands/tubes.py)."""
    POINTS = "points"
    """Spheres."""


@dataclass
class Mesh:
    """One evaluated mesh in its object space, shared by all its instances.

    Corners are Blender's loops: a corner joins a vertex to a face and carries normal and UV.
    """

    name: str
    positions: np.ndarray = field(metadata=declared("vertices", 3, types="float32", finite=False))
    """(vertices, 3) float32, meters."""
    corner_vertices: np.ndarray = field(metadata=declared("corners", types="int32", below="vertices"))
    """(corners,) int32, the vertex of each corner."""
    corner_normals: np.ndarray = field(metadata=declared("corners", 3, types="float32", finite=False))
    """(corners, 3) float32, unit shading normals; 0 on flat faces, which take the normals of their triangles."""
    triangle_corners: np.ndarray = field(metadata=declared("triangles", 3, types="int32", below="corners"))
    """(triangles, 3) int32, the three corners of each triangle."""
    triangle_slots: np.ndarray = field(metadata=declared("triangles", types="int32", minimum=0))
    """(triangles,) int32, material slot of each triangle."""
    corner_uv: np.ndarray | None = field(default=None, metadata=declared("corners", 2, types="float32", finite=False))
    """(corners, 2) float32 of the UV map in use, or None."""
    texture_location: tuple[float, float, float] = (0.0, 0.0, 0.0)
    texture_size: tuple[float, float, float] = (1.0, 1.0, 1.0)
    """Middle and half extent of the box in which generated coordinates run from 0 to 1, object space."""
    attributes: dict[str, MeshAttribute] = field(default_factory=dict)
    """By name, those that the materials in use ask for."""
    dicing: Dicing | None = None
    """None: it is rendered as it is."""
    shape: MeshShape = MeshShape.SURFACE
    volume: Volume | None = None
    """Grids that the nodes of the volume inside read."""

    @property
    def triangle_count(self) -> int:
        """Triangles of the mesh alone."""
        return len(self.triangle_corners)

    def face_normals_filled(self, normals: np.ndarray, positions: np.ndarray) -> np.ndarray:
        """Corner normals (corners, 3), of which those that are 0 become those of their faces.

        positions: (vertices, 3). Corners of a face that is not plane have those of the triangles around them.
        """
        flat = ~normals.any(axis=1)
        if not flat.any():
            return normals
        triangles = self.triangle_corners[flat[self.triangle_corners[:, 0]]]
        points = positions[self.corner_vertices[triangles]].astype(np.float64)
        areas = np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0])
        corners = triangles.ravel()
        sums = [np.bincount(corners, np.repeat(areas[:, axis], 3), len(normals)) for axis in range(3)]
        found = np.stack(sums, axis=-1)[flat]
        lengths = np.linalg.norm(found, axis=1, keepdims=True)
        result = normals.copy()
        result[flat] = np.divide(found, lengths, out=np.zeros_like(found), where=lengths > 0.0)
        return result


class RayVisibility(enum.IntFlag):
    """Rays that see an object; the numbers are those of the GLSL side."""

    CAMERA = 1
    DIFFUSE = 2
    GLOSSY = 4
    TRANSMISSION = 8
    SHADOW = 16
    VOLUME_SCATTER = 32
    """Rays that media scatter: of lights, these are the rays by which they light media."""
    ALL = 63


@dataclass(slots=True)
class Particle:
    """Outputs of the Particle Info node for the particle that an instance stands for."""

    index: float = field(default=0.0, metadata=declared(finite=False))
    random: float = field(default=0.0, metadata=declared(finite=False))
    age: float = field(default=0.0, metadata=declared(finite=False))
    """Frames."""
    lifetime: float = field(default=0.0, metadata=declared(finite=False))
    """Frames."""
    size: float = field(default=0.0, metadata=declared(finite=False))
    location: tuple[float, float, float] = field(default=(0.0, 0.0, 0.0), metadata=declared(finite=False))
    velocity: tuple[float, float, float] = field(default=(0.0, 0.0, 0.0), metadata=declared(finite=False))
    angular_velocity: tuple[float, float, float] = field(default=(0.0, 0.0, 0.0), metadata=declared(finite=False))


@dataclass(slots=True)
class Instance:
    """A mesh placed in the world."""

    mesh: int = field(metadata=declared(below="meshes"))
    """Index into Scene.meshes."""
    matrix: np.ndarray = field(metadata=declared(4, 4, finite=False))
    """(4, 4) float64, object to world."""
    materials: list[int] = field(default_factory=list, metadata=declared(below="materials", minimum=-1))
    """Index into Scene.materials of each material slot, -1 for none; slots beyond the end take the last."""
    object_name: str = ""
    object_index: int = 0
    color: tuple[float, float, float, float] = (1.0, 1.0, 1.0, 1.0)
    """The object's color and alpha, for the Object Info node."""
    random: float = 0.0
    """0 to 1, one number for each instance."""
    particle: Particle | None = None
    visibility: RayVisibility = RayVisibility.ALL
    holdout: bool = False
    """Whether the camera sees a hole in place of it."""
    shadow_catcher: bool = False
    """Whether the camera sees nothing of it but the shadows on it."""
    attributes: dict[str, tuple[float, ...]] = field(default_factory=dict, metadata=declared(finite=False))
    """Values of attributes that the object or its instancer has as a whole, in place of those of the mesh."""
    light_group: str = ""
    """Whose pass the light belongs to that it emits (RenderSettings.light_groups); "" is none."""
    linking: LightLinking | None = None
    """None: all lights shine on it, and it stops them."""
    terminator_geometry_offset: float = field(default=0.0, metadata=declared(minimum=0.0, maximum=1.0))
    """Cosine up to which shadow rays begin on the surface that the normals describe, not on its triangles."""
    terminator_shading_offset: float = field(default=0.0, metadata=declared(minimum=0.0, maximum=1.0))
    """How much earlier than at the horizon the light of lights fades out; 1 is at 45 degrees."""


@dataclass(slots=True, eq=False)
class ParticleArray:
    """Outputs of the Particle Info node for the particles that the instances of an array stand for."""

    index: np.ndarray = field(metadata=declared("instances", finite=False))
    random: np.ndarray = field(metadata=declared("instances", finite=False))
    age: np.ndarray = field(metadata=declared("instances", finite=False))
    """Frames."""
    lifetime: np.ndarray = field(metadata=declared("instances", finite=False))
    """Frames."""
    size: np.ndarray = field(metadata=declared("instances", finite=False))
    location: np.ndarray = field(metadata=declared("instances", 3, finite=False))
    velocity: np.ndarray = field(metadata=declared("instances", 3, finite=False))
    angular_velocity: np.ndarray = field(metadata=declared("instances", 3, finite=False))

    def __len__(self) -> int:
        return len(self.index)

    @classmethod
    def joined(cls, arrays: Sequence["ParticleArray"]) -> "ParticleArray":
        """The particles of several arrays, one array after the other."""
        names = [member.name for member in dataclasses.fields(cls)]
        return cls(*(np.concatenate([getattr(array, name) for array in arrays]) for name in names))

    def rows(self, chosen: np.ndarray | slice) -> "ParticleArray":
        """The particles of these indices."""
        return ParticleArray(*(getattr(self, member.name)[chosen] for member in dataclasses.fields(self)))

    def __getitem__(self, index: int) -> Particle:
        return self.rows(slice(index, index + 1)).particles()[0]

    def particles(self) -> list[Particle]:
        """The particles one by one."""
        numbers = (self.index, self.random, self.age, self.lifetime, self.size)
        vectors = (self.location, self.velocity, self.angular_velocity)
        columns = [column.tolist() for column in numbers]
        columns += [list(map(tuple, column.tolist())) for column in vectors]
        return list(map(Particle, *columns))


@dataclass(slots=True, eq=False, weakref_slot=True)
class InstanceArray:
    """Many instances of one mesh that share all but what arrays say of each. It is not changed once it is made."""

    first: Instance
    """The first of them, whose mesh, materials and other members all have."""
    places: np.ndarray = field(metadata=declared("instances", types="int32", minimum=0))
    """(instances,) int32, ascending, the index of each among all instances of the scene."""
    matrices: np.ndarray = field(metadata=declared("instances", 3, 4, types="float32", finite=False))
    """(instances, 3, 4) float32, object to world, without the last row 0, 0, 0, 1."""
    randoms: np.ndarray = field(metadata=declared("instances", types="float64", finite=False))
    """(instances,) float64, 0 to 1, the random number of each."""
    particles: ParticleArray | None = None
    """None: they stand for no particles."""
    attributes: dict[str, np.ndarray] = field(default_factory=dict, metadata=declared(finite=False))
    """By name, (instances, channels) float64, values of the attributes that differ; all have the other attributes of
    the first."""

    @classmethod
    def joined(cls, arrays: Sequence["InstanceArray"]) -> "InstanceArray":
        """The instances of arrays with the same members and attributes, whose places follow each other."""
        if len(arrays) == 1:
            return arrays[0]
        particles = [array.particles for array in arrays if array.particles is not None]
        return cls(
            arrays[0].first,
            np.concatenate([array.places for array in arrays]),
            np.concatenate([array.matrices for array in arrays]),
            np.concatenate([array.randoms for array in arrays]),
            ParticleArray.joined(particles) if particles else None,
            {name: np.concatenate([array.attributes[name] for array in arrays]) for name in arrays[0].attributes},
        )

    def __len__(self) -> int:
        return len(self.places)

    def instances(self, before: "InstanceArray | None" = None) -> list[Instance]:
        """The instances one by one, the same objects at each call. ``before``: an array with whose instances this one
        shares those that say the same, bit for bit."""
        known = _expanded.get(self)
        if known is None:
            known = _expanded[self] = self._expand(before)
        return known

    def _expand(self, before: "InstanceArray | None") -> list[Instance]:
        known = None if before is None or not self._is_like(before) else _expanded.get(before)
        if known is None or before is None:
            return self._made(slice(None))
        differs = _differing_rows(self.matrices, before.matrices) | _differing_rows(self.randoms, before.randoms)
        for name, values in self.attributes.items():
            differs |= _differing_rows(values, before.attributes[name])
        rows, instances = np.flatnonzero(differs), list(known)
        for row, instance in zip(rows.tolist(), self._made(rows), strict=True):
            instances[row] = instance
        return instances

    def _is_like(self, other: "InstanceArray") -> bool:
        """True where arrays have as many instances, and these share the same, without particles."""
        return (
            len(self) == len(other)
            and self.particles is other.particles is None
            and self.attributes.keys() == other.attributes.keys()
            and repr(_shared_members(self.first)) == repr(_shared_members(other.first))
        )

    def _made(self, rows: np.ndarray | slice) -> list[Instance]:
        """New instances of rows."""
        randoms = self.randoms[rows]
        matrices = np.zeros((len(randoms), 4, 4))
        matrices[:, :3] = self.matrices[rows]
        matrices[:, 3, 3] = 1.0
        shared, count = self.first, len(randoms)
        particles = [None] * count if self.particles is None else self.particles.rows(rows).particles()
        attributes = [shared.attributes] * count
        if self.attributes:
            columns = [list(map(tuple, column[rows].tolist())) for column in self.attributes.values()]
            own = zip(*columns, strict=True)
            attributes = [shared.attributes | dict(zip(self.attributes, row, strict=True)) for row in own]
        return [
            Instance(
                shared.mesh,
                matrix,
                shared.materials,
                shared.object_name,
                shared.object_index,
                shared.color,
                random,
                particle,
                shared.visibility,
                shared.holdout,
                shared.shadow_catcher,
                own_attributes,
                shared.light_group,
                shared.linking,
                shared.terminator_geometry_offset,
                shared.terminator_shading_offset,
            )
            for matrix, random, particle, own_attributes in zip(
                matrices, randoms.tolist(), particles, attributes, strict=True
            )
        ]


_OWN = {"matrix", "random", "particle"}
"""Members that the instances of an array do not share."""


def _shared_members(instance: Instance) -> list[object]:
    return [getattr(instance, member.name) for member in dataclasses.fields(Instance) if member.name not in _OWN]


def _differing_rows(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """(n,) bool, the rows of two arrays of n rows that differ in a bit; all where their types or widths do."""
    if a.shape != b.shape or a.dtype != b.dtype:
        return np.ones(len(a), bool)
    bits = np.dtype(f"u{a.dtype.itemsize}")
    x, y = (np.ascontiguousarray(array).view(bits).reshape(len(array), -1) for array in (a, b))
    return np.asarray((x != y).any(axis=1))


_expanded: weakref.WeakKeyDictionary[InstanceArray, list[Instance]] = weakref.WeakKeyDictionary()
"""Instances of arrays that were asked for."""
