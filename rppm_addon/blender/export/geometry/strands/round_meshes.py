# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair curves, hair of particle systems and point clouds as meshes of round shapes."""

from collections.abc import Hashable
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np

from .....scene import AttributeDomain, Mesh, MeshAttribute, MeshShape
from .....scene.errors import SceneError
from .....scene.storage.sharing import keep_equal
from ...common.hashing import hashed_up_to
from ...common.matrices import usable_matrices
from ...common.report import Report
from ...common.slices import Slices
from ..meshes.attributes import GENERATED
from ..meshes.meshes import FARTHEST, NO_MESH
from . import curves, particle_hair
from .attributes import (
    OF_ROUND_SHAPES,
    POINT_PLACE,
    POINT_RADIUS,
    POINT_RANDOM,
    read_values,
    strand_values,
)
from .curve_settings import CurveSettings
from .particle_hair import HairSystem
from .point_clouds import Points, read_points
from .spheres import level_of, sphere_triangles, sphere_vertices, unit_sphere
from .tubes import MOST_TRIANGLES, Rings, Strands, rings_of, tube_triangles, tube_vertices, usable

_MIDDLE = (0.5, 0.5, 0.5)
"""Location and size of a texture space in which generated coordinates equal object coordinates, as in Cycles where
there are no others."""


@dataclass(frozen=True)
class Hair:
    """The hair that the particle systems of an evaluated object have."""

    source: bpy.types.Object
    systems: list[HairSystem]
    uses_uv: bool
    """Whether anything asks for places on the surface that it grows on."""

    def as_pointer(self) -> int:
        """Return the address of the object, which tells its hair from other hair in memory."""
        return self.source.as_pointer()

    def read(self) -> Strands:
        """Its strands, in the space of the object."""
        (matrix,), (is_usable,) = usable_matrices(np.array([self.source.matrix_world], np.float64))
        # What is scaled to 0 is left out afterwards.
        return particle_hair.read_hair(self.source, self.systems, np.linalg.inv(matrix) if is_usable else np.eye(4))


RoundSource = bpy.types.Curves | bpy.types.PointCloud | Hair
ROUND_TYPES = {"CURVES", "POINTCLOUD"}
"""Types of objects that are rendered as round shapes."""


def export_round(
    data: RoundSource,
    name: str,
    settings: CurveSettings,
    report: Report,
    before: Mesh | None,
    slices: Slices,
    record: dict[Hashable, Any],
) -> Mesh | None:
    """Tubes or spheres of evaluated data, in its object's space; None where there are none.

    before: what it may resemble; arrays that are the same are its very arrays. record: what was read of it in slices
    before; afterwards also what export_round_attribute reads. Raises Unfinished, and SceneError where there would be
    more triangles than any device holds.
    """
    before = before or NO_MESH
    if isinstance(data, bpy.types.PointCloud):
        return _spheres(data, name, report, before, slices, record)
    strands = _strands(data, settings, slices, record)
    if record["read"] is not strands and not np.isfinite(record["read"].keys).all():
        report.warn(f'Object "{name}": strands with points that are not finite or too far away are left out')
    if len(strands.slots) == 0:
        return None
    rings = slices.computed(record, "rings", lambda: rings_of(strands, settings.most_parts))
    _demand_room(
        rings.triangle_count,
        f'Object "{name}": its {len(strands.slots)} strands',
        "lower the children or the steps of its particles, the points of its curves, or Cycles' Curve Subdivisions",
    )
    positions, normals = slices.computed(record, "vertices", lambda: tube_vertices(strands, rings))
    triangles = slices.computed(record, "triangles", lambda: tube_triangles(rings))
    uv = slices.step(record, "uv", lambda: _uv(data, strands, rings))
    slots = _slots(strands, rings)
    return _mesh(name, MeshShape.STRANDS, positions, normals, triangles, slots, uv, before)


def _strands(
    data: bpy.types.Curves | Hair, settings: CurveSettings, slices: Slices, record: dict[Hashable, Any]
) -> Strands:
    found = slices.step(record, "read", lambda: _read(data, settings))
    return slices.computed(record, "strands", lambda: usable(found, FARTHEST))


def _read(data: bpy.types.Curves | Hair, settings: CurveSettings) -> Strands:
    found = curves.read_curves(data) if isinstance(data, bpy.types.Curves) else data.read()
    found.smooth &= settings.smooth
    return found


def _slots(strands: Strands, rings: Rings) -> np.ndarray:
    if not strands.slots.any():
        return np.zeros(rings.triangle_count, np.int32)
    return np.repeat(strands.slots, 2 * rings.sides * (np.diff(rings.starts) - 1))


def _uv(data: bpy.types.Curves | Hair, strands: Strands, rings: Rings) -> np.ndarray | None:
    """(vertices, 2) float32, where strands grow on the UV map of their surface that is rendered."""
    if isinstance(data, bpy.types.Curves):
        uv = curves.surface_uv(data)
    else:
        layers = data.source.data.uv_layers if data.uses_uv else ()
        active = next((number for number, layer in enumerate(layers) if layer.active_render), None)
        uv = None if active is None else particle_hair.surface_uv(data.systems, active)
    return None if uv is None else rings.per_vertex(rings.of_strands(uv if strands.kept is None else uv[strands.kept]))


def _spheres(
    data: bpy.types.PointCloud, name: str, report: Report, before: Mesh, slices: Slices, record: dict[Hashable, Any]
) -> Mesh | None:
    points = slices.step(record, "points", lambda: read_points(data, FARTHEST))
    if points.kept is not None and not points.kept.all():
        report.warn(
            f'Object "{name}": {np.count_nonzero(~points.kept)} points have no radius, are not finite or too far away; '
            "they are left out"
        )
    count = len(points.radii)
    if count == 0:
        return None
    level = level_of(count)
    _demand_room(
        count * len(unit_sphere(level)[1]), f'Object "{name}": its {count} points', "have fewer points in a cloud"
    )
    positions, normals = slices.computed(
        record, "vertices", lambda: sphere_vertices(points.places, points.radii, level)
    )
    triangles = slices.computed(record, "triangles", lambda: sphere_triangles(count, level))
    slots = np.zeros(len(triangles), np.int32)
    return _mesh(name, MeshShape.POINTS, positions, normals, triangles, slots, None, before)


def _mesh(
    name: str,
    shape: MeshShape,
    positions: np.ndarray,
    normals: np.ndarray,
    triangles: np.ndarray,
    slots: np.ndarray,
    uv: np.ndarray | None,
    before: Mesh,
) -> Mesh:
    """Corners are vertices."""
    return Mesh(
        name=name,
        positions=keep_equal(before.positions, positions),
        corner_vertices=keep_equal(before.corner_vertices, np.arange(len(positions), dtype=np.int32)),
        corner_normals=keep_equal(before.corner_normals, normals),
        triangle_corners=keep_equal(before.triangle_corners, triangles),
        triangle_slots=keep_equal(before.triangle_slots, slots),
        corner_uv=None if uv is None else keep_equal(before.corner_uv, uv),
        texture_location=_MIDDLE,
        texture_size=_MIDDLE,
        shape=shape,
    )


def _demand_room(triangles: int, what: str, remedy: str) -> None:
    if triangles > MOST_TRIANGLES:
        raise SceneError(
            f"{what} would make {triangles:,} triangles, of which a device holds {MOST_TRIANGLES:,}; {remedy}"
        )


def export_round_attribute(
    data: RoundSource,
    name: str,
    settings: CurveSettings,
    slices: Slices,
    record: dict[Hashable, Any],
) -> MeshAttribute | None:
    """An attribute of what export_round exported, None where there is none. Raises Unfinished."""
    key = "attribute", name  # its name alone may be that of another entry of the record
    if isinstance(data, bpy.types.PointCloud):
        points = slices.step(record, "points", lambda: read_points(data, FARTHEST))
        values = slices.step(record, key, lambda: _point_values(data, points, name))
    else:
        strands = _strands(data, settings, slices, record)
        rings = slices.computed(record, "rings", lambda: rings_of(strands, settings.most_parts))
        if name in OF_ROUND_SHAPES:
            values = slices.computed(record, key, lambda: strand_values(strands, rings, name))
        elif isinstance(data, Hair):
            values = slices.step(record, key, lambda: _hair_values(data, strands, rings, name))
        else:
            values = slices.step(record, key, lambda: _curve_values(data, strands, rings, name))
    return None if values is None else MeshAttribute(AttributeDomain.POINT, values)


def _curve_values(data: bpy.types.Curves, strands: Strands, rings: Rings, name: str) -> np.ndarray | None:
    found = read_values(data, name)
    if found is None:
        return None
    values, domain = found
    if domain == "CURVE":
        return rings.per_vertex(rings.of_strands(values if strands.kept is None else values[strands.kept]))
    return rings.per_vertex(rings.of_keys(values if strands.kept_keys is None else values[strands.kept_keys]))


def _hair_values(data: Hair, strands: Strands, rings: Rings, name: str) -> np.ndarray | None:
    if name == GENERATED:  # those of the roots
        mesh = data.source.data
        size = np.array(mesh.texspace_size)
        half = np.where(size != 0.0, 0.5 / np.where(size != 0.0, size, 1.0), 0.0)
        places = (strands.keys[strands.starts[:-1]] - np.array(mesh.texspace_location)) * half + 0.5
        return rings.per_vertex(rings.of_strands(places.astype(np.float32)))
    layer = data.source.data.uv_layers.find(name)
    if layer < 0:
        return None
    uv = particle_hair.surface_uv(data.systems, layer)
    return rings.per_vertex(rings.of_strands(uv if strands.kept is None else uv[strands.kept]))


def _point_values(data: bpy.types.PointCloud, points: Points, name: str) -> np.ndarray | None:
    """(vertices, components), the same on all of a sphere."""
    if name == POINT_PLACE:
        values = points.places
    elif name == POINT_RADIUS:
        values = points.radii[:, None]
    elif name == POINT_RANDOM:
        values = _kept(hashed_up_to(len(data.points))[:, None], points)
    else:
        found = read_values(data, name)
        if found is None:
            return None
        values = _kept(found[0], points)
    return np.repeat(values, len(unit_sphere(level_of(len(points.radii)))[0]), axis=0)


def _kept(values: np.ndarray, points: Points) -> np.ndarray:
    return values if points.kept is None else values[points.kept]


def round_shape_at(
    data: RoundSource, settings: CurveSettings, middle: Mesh, rings: Rings | None
) -> tuple[np.ndarray, np.ndarray] | None:
    """Positions and normals at another time of what export_round exported; None if strands or points are others.

    rings: of tubes, those of the middle.
    """
    if isinstance(data, bpy.types.PointCloud):
        points = read_points(data, FARTHEST)
        level = level_of(len(points.radii))
        if len(points.radii) * len(unit_sphere(level)[0]) != len(middle.positions):
            return None
        return sphere_vertices(points.places, points.radii, level)
    strands = usable(_read(data, settings), FARTHEST)
    if rings is None or len(strands.slots) != len(rings.starts) - 1 or len(strands.keys) != int(rings.after[-1]) + 1:
        return None
    return tube_vertices(strands, rings, middle.corner_normals[rings.sides * rings.starts[:-1]])


def round_velocities(data: RoundSource, rings: Rings | None) -> np.ndarray | None:
    """(vertices, 3) float32 meters a second of the point attribute "velocity" of what export_round exported; None
    without one, and where strands or points were left out."""
    if isinstance(data, Hair):
        return None
    found = read_values(data, "velocity")
    if found is None or found[1] != "POINT" or found[0].shape[1] != 3:
        return None
    velocities = found[0]
    if isinstance(data, bpy.types.PointCloud):
        points = read_points(data, FARTHEST)
        per_sphere = len(unit_sphere(level_of(len(points.radii)))[0])
        return np.repeat(_kept(velocities, points), per_sphere, axis=0)
    if rings is None or len(velocities) != int(rings.after[-1]) + 1:
        return None
    return rings.per_vertex(rings.of_keys(velocities))
