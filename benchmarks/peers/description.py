# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene as every renderer can be given it: triangles, three materials, four lights, a gray world, a pinhole camera.

Lengths in meters, Z up, colors and radiance scene-linear Rec.709. NumPy only: adapters import this in their own
environments.
"""

import hashlib
import math
from dataclasses import dataclass

import numpy as np

Color = tuple[float, float, float]
Point = tuple[float, float, float]


@dataclass(frozen=True)
class Diffuse:
    """A Lambertian surface, on both sides."""

    color: Color = (0.7, 0.7, 0.7)


@dataclass(frozen=True)
class Glass:
    """A smooth dielectric; the normals of its mesh point to where the index is 1."""

    ior: float = 1.5


@dataclass(frozen=True)
class Mirror:
    """A smooth reflector with the same reflectance at all angles."""

    color: Color = (0.95, 0.95, 0.95)


Material = Diffuse | Glass | Mirror


@dataclass(frozen=True)
class Mesh:
    """Triangles of one material."""

    name: str
    vertices: np.ndarray
    """(V, 3) float64."""
    triangles: np.ndarray
    """(T, 3) int32; counterclockwise seen from outside."""
    material: Material
    normals: np.ndarray | None = None
    """(V, 3) unit shading normals; None is flat."""


@dataclass(frozen=True)
class AreaLight:
    """A square that emits evenly on one side, as a Lambertian surface does."""

    name: str
    position: Point
    direction: Point
    """Unit vector along which it emits."""
    size: float
    """Meters along each side."""
    power: float
    """Watts in all directions."""
    color: Color = (1.0, 1.0, 1.0)

    @property
    def radiance(self) -> float:
        """W/(m^2 sr), before the color."""
        return self.power / (math.pi * self.size**2)

    @property
    def corners(self) -> np.ndarray:
        """(4, 3), counterclockwise seen from where it shines."""
        x, y, _ = frame_of(self.direction)
        half = 0.5 * self.size
        return np.array(self.position) + half * np.array([-x - y, x - y, x + y, -x + y])


@dataclass(frozen=True)
class SphereLight:
    """A sphere that emits evenly."""

    name: str
    position: Point
    radius: float
    power: float
    """Watts in all directions."""
    color: Color = (1.0, 1.0, 1.0)

    @property
    def radiance(self) -> float:
        """W/(m^2 sr), before the color."""
        return self.power / (4.0 * math.pi**2 * self.radius**2)


@dataclass(frozen=True)
class SpotLight:
    """Blender's spot: a sphere whose light is let through within a cone. Blender's renderers only."""

    name: str
    position: Point
    direction: Point
    radius: float
    power: float
    """Watts of the sphere without the cone."""
    angle: float
    """Radians, of the whole cone."""
    blend: float = 0.15
    color: Color = (1.0, 1.0, 1.0)


@dataclass(frozen=True)
class SunLight:
    """A disk at infinity."""

    name: str
    direction: Point
    """Unit vector along which it shines."""
    irradiance: float
    """W/m^2 on a surface that faces it."""
    angle: float
    """Radians, the disk's diameter."""
    color: Color = (1.0, 1.0, 1.0)

    @property
    def radiance(self) -> float:
        """W/(m^2 sr) of the disk, before the color."""
        return self.irradiance / (math.pi * math.sin(0.5 * self.angle) ** 2)


Light = AreaLight | SphereLight | SpotLight | SunLight


@dataclass(frozen=True)
class Camera:
    """A pinhole with a square picture."""

    position: Point
    target: Point
    angle: float
    """Radians, of the whole picture's height."""

    @property
    def frame(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Unit vectors: right, up, and back toward the viewer."""
        back = np.array(self.position) - np.array(self.target)
        back = back / np.linalg.norm(back)
        right = np.cross((0.0, 0.0, 1.0), back)
        right = right / np.linalg.norm(right)
        return right, np.cross(back, right), back


@dataclass(frozen=True)
class Counts:
    """How large a scene is."""

    meshes: int
    triangles: int
    lights: int


@dataclass(frozen=True)
class Scene:
    """Scene to be rendered."""

    name: str
    title: str
    meshes: list[Mesh]
    lights: list[Light]
    camera: Camera
    world: float = 0.0
    """Radiance from everywhere, W/(m^2 sr)."""
    caustic: bool = False
    """Whether light that reaches diffuse surfaces by glass or mirrors is what the scene is about."""

    @property
    def counts(self) -> Counts:
        """Meshes, triangles and lights (without the world)."""
        return Counts(len(self.meshes), sum(len(mesh.triangles) for mesh in self.meshes), len(self.lights))

    @property
    def fingerprint(self) -> str:
        """16 hexadecimal digits that change with anything in the description."""
        digest = hashlib.sha256()
        for mesh in self.meshes:
            digest.update(repr((mesh.name, mesh.material)).encode())
            arrays = (mesh.vertices, mesh.triangles, *(() if mesh.normals is None else (mesh.normals,)))
            for array in arrays:
                digest.update(np.ascontiguousarray(array).tobytes())
        digest.update(repr((self.name, self.lights, self.camera, self.world)).encode())
        return digest.hexdigest()[:16]


def frame_of(direction: Point) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Three unit vectors (3,), right-handed, of which the last is the direction."""
    z = np.array(direction, np.float64)
    z = z / np.linalg.norm(z)
    other = np.array([1.0, 0.0, 0.0] if abs(z[0]) < 0.9 else [0.0, 1.0, 0.0])
    x = np.cross(other, z)
    x = x / np.linalg.norm(x)
    return x, np.cross(z, x), z


def unit(vector: Point) -> Point:
    """The vector with length 1."""
    length = math.sqrt(sum(value * value for value in vector))
    return tuple(value / length for value in vector)
