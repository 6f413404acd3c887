# SPDX-License-Identifier: GPL-3.0-or-later
"""Places of a scene where Cycles is known to be wrong: coincident faces, and lamps that lie exactly in a surface.

Its rays that leave one of two coincident faces meet the other, so these are black or speckled; and its shadow rays
end on a surface in which their lamp lies.
"""

import numpy as np
from mathutils import Vector
from mathutils.bvhtree import BVHTree

from rppm_addon.scene import Camera, LightKind, Scene

MOST_TRIANGLES = 3_000_000
"""Triangles of a scene that is looked at; for more the tree takes too long."""
RAYS = (48, 36)
"""Rays across and down the picture that look for coincident faces."""
NEAR = 2.0**-20
"""Distance that counts as none, as a share of the coordinates: eight float32 steps."""
PARALLEL = 1.0 - 1e-6
"""Least cosine between the normals of faces that coincide and do not just meet."""
INSIDE = 1e-3
"""Least barycentric coordinate of a point inside a triangle, so that neighbors do not count."""


class _Surfaces:
    """The triangles of a scene in the world, in a tree."""

    def __init__(self, scene: Scene) -> None:
        corners, names = [], []
        for instance in scene.expanded().instances:
            mesh = scene.meshes[instance.mesh]
            matrix = instance.matrix
            world = mesh.positions.astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
            corners.append(world[mesh.corner_vertices[mesh.triangle_corners]])
            names += [(instance.object_name, mesh.triangle_count)]
        self.corners = np.concatenate(corners) if corners else np.zeros((0, 3, 3))
        self.objects = np.repeat(np.arange(len(names)), [count for _, count in names])
        self.names = [name for name, _ in names]
        flat = self.corners.reshape(-1, 3)
        triangles = np.arange(len(flat)).reshape(-1, 3).tolist()
        self.tree = BVHTree.FromPolygons(flat.tolist(), triangles, all_triangles=True)

    def contains(self, triangle: int, point: np.ndarray) -> bool:
        """True where a point on a triangle's plane is well inside it."""
        a, b, c = self.corners[triangle]
        normal = np.cross(b - a, c - a)
        square = normal @ normal
        if square == 0.0:
            return False
        shares = [np.cross(q - p, point - p) @ normal / square for p, q in ((a, b), (b, c), (c, a))]
        return min(shares) > INSIDE

    def coincident(self, origin: np.ndarray, direction: np.ndarray) -> tuple[int, int] | None:
        """Two triangles that a ray meets at one point, the first there; or None."""
        point, normal, triangle, _ = self.tree.ray_cast(Vector(origin), Vector(direction))
        if point is None or not self.contains(triangle, np.array(point)):
            return None
        near = NEAR * max(np.abs(np.array(point)).max(), np.abs(origin).max(), 1e-3)
        for _, other_normal, other, _ in self.tree.find_nearest_range(point, near):
            parallel = abs(normal.dot(other_normal)) > PARALLEL
            if other != triangle and parallel and self.contains(other, np.array(point)):
                return triangle, other
        return None


def suspects_of(scene: Scene) -> list[str]:
    """Faults of Cycles in a scene, a line each; empty where nothing was found."""
    if scene.triangle_count > MOST_TRIANGLES:
        return [f"not looked at: {scene.triangle_count} triangles"]
    surfaces = _Surfaces(scene)
    return _coincident_faces(scene, surfaces) + _lamps_in_surfaces(scene, surfaces)


def coincident_pixels(scene: Scene, width: int, height: int) -> np.ndarray:
    """(height, width) bool, the top row first: pixels where any of four rays of the camera meets coincident faces."""
    surfaces = _Surfaces(scene)
    rays = zip(*_camera_rays(scene.camera, 2 * width, 2 * height))
    found = [surfaces.coincident(origin, direction) is not None for origin, direction in rays]
    return np.array(found).reshape(height, 2, width, 2).any(axis=(1, 3))[::-1]


def _coincident_faces(scene: Scene, surfaces: _Surfaces) -> list[str]:
    found, names = 0, set()
    origins, directions = _camera_rays(scene.camera, *RAYS)
    for origin, direction in zip(origins, directions):
        pair = surfaces.coincident(origin, direction)
        if pair is not None:
            found += 1
            names.add(tuple(sorted({surfaces.names[surfaces.objects[triangle]] for triangle in pair})))
    if not found:
        return []
    some = ", ".join(" and ".join(objects) for objects in sorted(names)[:3])
    return [f"coincident faces in {found / len(origins):.1%} of the picture ({some})"]


def _lamps_in_surfaces(scene: Scene, surfaces: _Surfaces) -> list[str]:
    found = []
    for light in scene.lights:
        place = light.matrix[:3, 3]
        if light.kind is LightKind.SUN or light.is_portal:
            continue
        point, normal, _, distance = surfaces.tree.find_nearest(Vector(place))
        if point is None or distance > NEAR * max(np.abs(place).max(), 1.0):
            continue
        axis = Vector(light.matrix[:3, 2]).normalized()
        if light.kind is not LightKind.AREA or abs(axis.dot(normal)) > 1.0 - 1e-4:
            found.append(light.name)
    return [f"lamps exactly in a surface: {', '.join(sorted(found)[:5])}"] if found else []


def _camera_rays(camera: Camera, columns: int, rows: int) -> tuple[np.ndarray, np.ndarray]:
    """(N, 3) origins and directions over the picture, row by row from below.

    A panorama looks at all that is around it."""
    across, up = (np.arange(count) + 0.37 for count in (columns, rows))
    x, y = (grid.ravel() for grid in np.meshgrid(across / columns, up / rows))
    left, right, bottom, top = camera.window
    at = np.stack([left + (right - left) * x, bottom + (top - bottom) * y], axis=-1)
    zeros = np.zeros((len(x), 1))
    if camera.panorama is not None:
        height, turn = 2.0 * y - 1.0, 2.0 * np.pi * x
        width = np.sqrt(1.0 - height**2)
        origins, directions = np.zeros((len(x), 3)), np.stack([width * np.cos(turn), width * np.sin(turn), height], -1)
    elif camera.orthographic:
        origins, directions = np.hstack([at, zeros]), np.hstack([zeros, zeros, zeros - 1.0])
    else:
        origins, directions = np.zeros((len(x), 3)), np.hstack([at, zeros - 1.0])
    turned = directions @ camera.matrix[:3, :3].T
    return origins @ camera.matrix[:3, :3].T + camera.matrix[:3, 3], turned
