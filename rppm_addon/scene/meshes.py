# SPDX-License-Identifier: GPL-3.0-or-later
"""Indexed geometry and its placements."""

import enum
from dataclasses import dataclass, field

import numpy as np

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
    """How finely a mesh is divided where it is displaced (Adaptive Subdivision)."""

    edge_length: float = field(metadata=declared(minimum=1e-6))
    """How long edges may be: in pixels, of which Scene.dicing_rate is the unit, or in meters, object space."""
    in_pixels: bool
    is_curved: bool
    """Whether faces bend by their normals as they are divided; else they stay flat."""


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
    """None: it is displaced as it is."""
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
