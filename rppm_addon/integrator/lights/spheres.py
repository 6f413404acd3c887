# SPDX-License-Identifier: GPL-3.0-or-later
"""Lights with a radius, and whether surfaces or media lie within it."""

from collections.abc import Set

import numpy as np

from ...scene.lights import Light, LightKind
from ...scene.meshes import Mesh
from ...scene.scene import Scene
from ..surfaces.geometry import Geometry

_MAX_TRIANGLES = 1 << 17
"""Meshes of more are taken to reach into a sphere that their box reaches into."""


def holds_surfaces(light: Light, scene: Scene, geometry: Geometry) -> bool:
    """True where triangles of the scene may lie within the radius of a light; geometry: the scene's.

    Of spots without Soft Falloff it is not asked: what their spheres light from within gives no indirect light.
    """
    is_disk = light.soft_falloff and light.kind in (LightKind.POINT, LightKind.SPOT)
    if not light.radius > 0.0 or not (is_disk or light.kind is LightKind.POINT):
        return False
    center, radius = _center(light), light.radius
    for number in _placements_met(light, geometry):
        mesh = scene.meshes[geometry.placements[number].instance.mesh]
        if mesh.triangle_count > _MAX_TRIANGLES or _reaches(mesh, geometry.matrices[number], center, radius):
            return True
    return False


def holds_medium(light: Light, scene: Scene, geometry: Geometry, media: Set[int]) -> bool:
    """True where a light is a sphere that may have a medium in it; media: materials that fill the inside of what they
    are on. A disk lights its surroundings from one side only."""
    if not light.radius > 0.0 or light.soft_falloff or light.kind not in (LightKind.POINT, LightKind.SPOT):
        return False
    if scene.world.volume is not None:
        return True
    met = _placements_met(light, geometry) if media else []
    return any(not media.isdisjoint(geometry.placements[number].instance.materials) for number in met)


def _center(light: Light) -> np.ndarray:
    return np.asarray(light.matrix, np.float64)[:3, 3]


def _placements_met(light: Light, geometry: Geometry) -> list[int]:
    """Numbers of the placements whose boxes reach into the sphere of a light."""
    with np.errstate(invalid="ignore"):  # boxes may not be finite
        distances = _distances_to_boxes(_center(light), geometry.boxes[:, 0], geometry.boxes[:, 1])
    return np.flatnonzero(distances <= light.radius).tolist()


def _distances_to_boxes(point: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """(n,) distances from a point to boxes, (n, 3) low and high."""
    return np.linalg.norm(np.maximum(np.maximum(low - point, point - high), 0.0), axis=1)


def _reaches(mesh: Mesh, matrix: np.ndarray, center: np.ndarray, radius: float) -> bool:
    """True where planes and boxes of a placed mesh's triangles let any of these reach into a sphere."""
    points = mesh.positions.astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3] - center
    corners = points[mesh.corner_vertices[mesh.triangle_corners]]
    near = _distances_to_boxes(np.zeros(3), corners.min(axis=1), corners.max(axis=1)) <= radius
    a, b, c = np.moveaxis(corners[near], 1, 0)
    normals = np.cross(b - a, c - a)
    return bool((np.abs((a * normals).sum(axis=1)) <= radius * np.linalg.norm(normals, axis=1)).any())
