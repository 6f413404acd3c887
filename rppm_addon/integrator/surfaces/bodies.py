# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies with a medium inside whose surface leaves open where that is."""

from collections.abc import Collection

import numpy as np

from ...scene.meshes import Mesh, MeshShape
from ...scene.scene import Scene

_MAX_TRIANGLES = 1 << 20
"""Largest meshes that are looked at: sorting the edges of more would take seconds."""


_WELDED = 1e-6
"""Distance, at most, between vertices that count as one, as a part of a mesh's size."""


def is_closed(mesh: Mesh) -> bool:
    """True where each edge of a mesh is one of as many triangles from one side as from the other.

    Vertices at nearly the same place are one, and triangles without area do not count.
    """
    positions = np.nan_to_num(mesh.positions)
    grid = max(float(np.ptp(positions, axis=0).max()) * _WELDED, 1e-30)
    _, places = np.unique(np.round(positions / grid), axis=0, return_inverse=True)
    corners = places.reshape(-1)[mesh.corner_vertices[mesh.triangle_corners]].astype(np.int64)
    corners = corners[(corners != np.roll(corners, 1, axis=1)).all(axis=1)]
    starts, ends = corners.ravel(), np.roll(corners, -1, axis=1).ravel()
    edges, sides = np.minimum(starts, ends) * len(mesh.positions) + np.maximum(starts, ends), np.sign(ends - starts)
    _, number = np.unique(edges, return_inverse=True)
    return not np.bincount(number.reshape(-1), weights=sides).any()


def warn_of_open_bodies(scene: Scene, filled: Collection[int], checked: dict[int, tuple[Mesh, bool]]) -> None:
    """Warn of objects that have a medium inside and no inside.

    filled: materials (indices) with a medium; checked: answers for meshes by id, to be kept from scene to scene.
    """
    known = dict(checked)
    checked.clear()
    names = []
    for instance in scene.instances:
        mesh = scene.meshes[instance.mesh]
        if not set(filled).intersection(instance.materials) or mesh.shape is not MeshShape.SURFACE:
            continue
        if not 0 < mesh.triangle_count <= _MAX_TRIANGLES:
            continue
        key = id(mesh)
        if key not in checked:
            checked[key] = known[key] if key in known else (mesh, is_closed(mesh))
        if not checked[key][1]:
            names.append(instance.object_name or mesh.name)
    for name in dict.fromkeys(names):
        scene.warn(f'Object "{name}" has a volume, but holes in its mesh: light that gets in may never come out')
