# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh divided as finely as the camera sees it, with all that its vertices, corners and triangles carry."""

import dataclasses
import functools
from collections.abc import Callable

import numpy as np

from ....scene.camera import Camera
from ....scene.meshes import SMOOTH_NORMALS, AttributeDomain, DicingView, Instance, Mesh, MeshAttribute
from ....scene.motion import Deformation
from ..unit_vectors import unit_vectors
from .curved_triangles import CurvedTriangles, creased_normals
from .edge_lengths import EdgeLengths
from .refinement import Refinement, Refiner, TooManyTriangles

MOST_TRIANGLES = 1 << 20
"""Largest number of triangles of all instances of a divided mesh together."""
_MIN_COARSENING = 1.1
"""Least factor by which edges become longer at a time where there are too many triangles."""


class DicedMesh:
    """A mesh whose edges are halved until they are as short as its dicing asks for: its own vertices come first."""

    def __init__(self, mesh: Mesh, instances: list[Instance], camera: Camera, view: DicingView) -> None:
        """instances: those that show the mesh. camera: by which edges are measured."""
        self._source = mesh
        self._vertices = mesh.corner_vertices[mesh.triangle_corners]
        self.coarsening = 1.0
        """Factor by which edges are longer than it is asked for, as there would be too many triangles."""
        self._refinement = self._refined(EdgeLengths(mesh, instances, camera, view), view, len(instances))

    def _refined(self, lengths: EdgeLengths, view: DicingView, instances: int) -> Refinement:
        source, dicing = self._source, self._source.dicing
        assert dicing is not None
        shape = self._shape(source.positions)
        refiner = Refiner(self._vertices, source.positions, shape.points, lengths.seen, lengths.between)
        rounds = max(view.max_subdivisions - dicing.base_level, 0)
        most = max(MOST_TRIANGLES // max(instances, 1), source.triangle_count)
        while True:
            try:
                return refiner.refine(rounds, self.coarsening, most)
            except TooManyTriangles as error:
                self.coarsening *= max(float(np.sqrt(error.excess)), _MIN_COARSENING)

    @functools.cached_property
    def _corners(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Triangle of the source (corners,), barycentrics there (corners, 3) and vertex (corners,) of each corner, and
        the corners of the triangles (triangles, 3)."""
        found = self._refinement
        count = len(self._source.positions) + len(found.added_sources)
        keys = (found.sources[:, None] * count + found.triangles).reshape(-1)
        unique, first, which = np.unique(keys, return_index=True, return_inverse=True)
        weights = found.weights.reshape(-1, 3)[first]
        return unique // count, weights, unique % count, which.reshape(-1, 3)

    @functools.cached_property
    def mesh(self) -> Mesh:
        """The divided one."""
        source, found = self._source, self._refinement
        _, _, vertices, triangle_corners = self._corners
        return dataclasses.replace(
            source,
            positions=self.positions(source.positions),
            corner_vertices=vertices.astype(np.int32),
            corner_normals=self.normals(source.positions, source.corner_normals),
            triangle_corners=triangle_corners.astype(np.int32),
            triangle_slots=source.triangle_slots[found.sources],
            corner_uv=None if source.corner_uv is None else self._of_corners(source.corner_uv),
            attributes={name: self._attribute(name, attribute) for name, attribute in source.attributes.items()},
            dicing=None,
        )

    def deformed(self, deformation: Deformation) -> Deformation:
        """The shapes of the divided mesh."""
        keys = list(zip(deformation.positions, deformation.corner_normals, strict=True))
        positions = np.stack([self.positions(shape) for shape in deformation.positions])
        normals = np.stack([self.normals(*key) for key in keys])
        return Deformation(deformation.mesh, deformation.times, positions, normals)

    def positions(self, positions: np.ndarray) -> np.ndarray:
        """(vertices, 3) float32 of the mesh with these positions (vertices, 3)."""
        return self._of_vertices(positions, self._shape(positions).points)

    def normals(self, positions: np.ndarray, corner_normals: np.ndarray) -> np.ndarray:
        """(corners, 3) float32 of the mesh with these positions (vertices, 3) and normals (corners, 3)."""
        if self._is_curved:
            corner_normals = creased_normals(self._source, positions, corner_normals)
        return unit_vectors(self._of_corners(corner_normals))

    @property
    def _is_curved(self) -> bool:
        dicing = self._source.dicing
        return dicing is not None and dicing.is_curved

    def _shape(self, positions: np.ndarray) -> CurvedTriangles:
        return CurvedTriangles(self._vertices, positions, self._is_curved)

    def _attribute(self, name: str, attribute: MeshAttribute) -> MeshAttribute:
        values = attribute.values
        if attribute.domain is AttributeDomain.TRIANGLE:
            return MeshAttribute(attribute.domain, values[self._refinement.sources])
        if attribute.domain is AttributeDomain.POINT:
            flat = CurvedTriangles(self._vertices, values, False)
            return MeshAttribute(attribute.domain, self._of_vertices(values, flat.points))
        mixed = self._of_corners(values)
        if name == SMOOTH_NORMALS:
            mixed[:, :3] = unit_vectors(mixed[:, :3])
        return MeshAttribute(attribute.domain, mixed)

    def _of_corners(self, values: np.ndarray) -> np.ndarray:
        sources, weights, _, _ = self._corners
        corners = self._source.triangle_corners[sources]
        mixed = sum(weights[:, corner, None] * values[corners[:, corner]] for corner in range(3))
        return np.asarray(mixed, np.float32)

    def _of_vertices(self, values: np.ndarray, points: Callable[[np.ndarray, np.ndarray], np.ndarray]) -> np.ndarray:
        """(vertices, channels) float32: values (vertices, channels) of the source, then those of the points added."""
        added = points(self._refinement.added_sources, self._refinement.added_weights)
        return np.concatenate([values, added]).astype(np.float32)
