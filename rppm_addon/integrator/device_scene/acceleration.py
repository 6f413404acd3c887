# SPDX-License-Identifier: GPL-3.0-or-later
"""Acceleration: which structure a scene's rays are traced through, and when it is built anew."""

import dataclasses

import numpy as np

from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ...scene.passes import DEEP_CUBEMAP
from ...scene.scene import Scene
from ...scene.settings import AccelerationStructure as Kind
from ...scene.settings import Instancing
from ..acceleration.acceleration_structure import AccelerationStructure
from ..bvh.bvh import Bvh
from ..common.instance_columns import InstanceColumns
from ..common.require import require
from ..deep_cubemap.deep_cubemap import DeepCubemap
from ..deep_cubemap.placement import cubemap_centers, radius_about
from ..surfaces.geometry import Geometry
from .changes import Changes
from .instancing import MovedInstances, fits_expanded, instanced_members, most_expanded_triangles

_MAX_CORE_TRIANGLES = 64


class Acceleration:
    """The acceleration structure that the settings ask for, on the device."""

    def __init__(self, context: Context, library: ProgramLibrary) -> None:
        self._context, self._library = context, library
        self._structure: AccelerationStructure | None = None
        self.center = np.full(3, np.nan)
        """Center of the deep cubemap, and of the cubemaps that photons are splatted into, (3,) meters."""
        self._wanted_center = self.center
        self._moved = MovedInstances()

    @property
    def structure(self) -> AccelerationStructure:
        """Acceleration structure that rays are traced through, once it was built."""
        return require(self._structure)

    def kind(self, scene: Scene) -> Kind:
        """The structure for a scene: what its settings ask for.

        AUTOMATIC is the BVH where a software driver traces, which takes two thirds to a fifth of the time for a ray
        (docs/benchmarks/moves.md), and the deep cubemap on a GPU, which builds it by rasterization. The pass that
        pictures the deep cubemap needs one in any case.
        """
        asked = scene.settings.acceleration_structure
        if DEEP_CUBEMAP.name in scene.settings.passes:
            return Kind.DEEP_CUBEMAP
        if asked is not Kind.AUTOMATIC:
            return asked
        return Kind.BVH if self._context.is_software else Kind.DEEP_CUBEMAP

    def settled(self, scene: Scene) -> Scene:
        """The scene, with two levels asked for where its settings leave that to RPPM and the device does not hold the
        triangles of all instances. So what follows from the settings alone agrees, as the route to the camera's first
        hits does."""
        settings = scene.settings
        if settings.instancing is not Instancing.AUTOMATIC:
            return scene
        if fits_expanded(scene, most_expanded_triangles(self._context)):
            return scene
        return dataclasses.replace(scene, settings=dataclasses.replace(settings, instancing=Instancing.TWO_LEVELS))

    def instanced_members(self, scene: Scene, columns: InstanceColumns) -> np.ndarray | None:
        """(instances,) bool, the instances of a scene that are not expanded to world triangles; None for none. A scene
        with a shutter has the same ones at all of its moments, of any of which the columns may be."""
        return instanced_members(scene, columns, self._moved.follow(scene), self._context.is_software)

    def update(self, scene: Scene, geometry: Geometry, changes: Changes, center_tolerance: float = np.inf) -> None:
        """Build the structure where what it rests on has changed, or where it is not what the scene asks for.

        center_tolerance: how far from where the deep cubemap's center should be it may stay, in radii of the scene.
        Raises DeviceError.
        """
        kind = self.kind(scene)
        is_outdated = changes.geometry or not isinstance(self._structure, _CLASSES[kind])
        wanted = next(cubemap_centers(scene, geometry))
        distance = np.linalg.norm(wanted - self._wanted_center)
        stays = distance <= center_tolerance * geometry.radius and not changes.cubemap
        if is_outdated or (kind is Kind.DEEP_CUBEMAP and not stays):
            self.build(scene, geometry, kind)
        elif not stays:
            self.center = self._wanted_center = wanted

    def build(self, scene: Scene, geometry: Geometry, kind: Kind) -> None:
        """Build a structure of the scene's triangles, which rays are traced through from now on. Raises DeviceError."""
        structure = self._structure
        if structure is None or not isinstance(structure, _CLASSES[kind]):
            self.release()
            if kind is Kind.BVH:
                structure = Bvh(self._context, self._library)
            else:
                # Where no unit rasterizes that takes two to three times as long, and trying it most of the first build.
                rasterize = False if self._context.is_software else None
                structure = DeepCubemap(self._context, self._library, rasterize=rasterize)
            self._structure = structure
        centers = list(cubemap_centers(scene, geometry))
        self._wanted_center = centers[0]
        for self.center in centers:
            structure.build(
                geometry.triangles.buffer,
                geometry.triangle_count,
                self.center,
                radius_about(self.center, geometry),
                scene.settings.cubemap_resolution,
                geometry.has_round_shapes,
                geometry.instanced,
            )
            # Where few triangles touch the center: those are tested by every ray that passes it.
            if not isinstance(structure, DeepCubemap) or structure.counts["core"] <= _MAX_CORE_TRIANGLES:
                break

    @property
    def memory_bytes(self) -> dict[str, int]:
        """Bytes on the device by buffer."""
        return self._structure.memory_bytes if self._structure is not None else {}

    def release(self) -> None:
        """Give all buffers back."""
        if self._structure is not None:
            self._structure.release()
            self._structure = None


_CLASSES: dict[Kind, type[AccelerationStructure]] = {Kind.BVH: Bvh, Kind.DEEP_CUBEMAP: DeepCubemap}
