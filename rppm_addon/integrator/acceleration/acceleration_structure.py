# SPDX-License-Identifier: GPL-3.0-or-later
"""AccelerationStructure: what the structures that rays are traced through have in common."""

from collections.abc import Iterable, Mapping

import moderngl

from ...gl.buffer_sets import BufferSet
from ...gl.context.context import Context
from ...gl.programs.program import Bindable
from ...gl.programs.programs import ProgramLibrary
from ..common.active_paths import ActivePaths
from ..common.records.rays import HIT, RAY  # noqa: F401  the kernels have blocks of them
from ..common.records.triangles import TRIANGLE_VERTICES  # noqa: F401  likewise
from .instances import HitNumbers, HitPaths, InstancedMeshes

MARGIN = 2.0**-20
"""How far cells and boxes are widened, in radii of the scene. That is thirty times the rounding error of float
positions, so that a point that a ray reaches is found in the cell or box of its triangle."""


class AccelerationStructure(BufferSet):
    """Triangles on the device, sorted in space so that a ray need not be tested with all of them.

    Which structure it is changes no hit: of equal distances the triangle with the lowest number is hit.
    """

    shader = ""
    """The file below the shader folder that kernels include in place of ``#include TRAVERSAL``. It defines
    nearest_hit(ray), is_occluded(ray) and trace_ray(ray, any_hit)."""

    def __init__(self, context: Context, library: ProgramLibrary) -> None:
        super().__init__(context, library)
        self._context, self._library = context, library
        self._has_one_sided = False
        self._traversal_buffers: dict[str, Bindable] = {}
        self._instanced: InstancedMeshes | None = None

    def build(
        self,
        triangles: moderngl.Buffer,
        triangle_count: int,
        center: Iterable[float],
        scene_radius: float,
        resolution: int = 0,
        has_one_sided: bool = False,
        instanced: InstancedMeshes | None = None,
    ) -> None:
        """Sort triangles into the structure.

        ``triangles`` holds three vec4 a triangle and must stay as it is while rays are traced. ``scene_radius``: the
        greatest distance from ``center`` of any vertex (meters); nothing farther out is hit. Rays may start anywhere,
        yet lose precision from some ten radii on. ``resolution``: of a deep cubemap. ``has_one_sided``: whether any
        triangle is met by rays from outside only. ``instanced``: instances that rays are to meet as well, where the
        structure has two levels. Triangles with infinite or NaN coordinates are left out.
        Raises ValueError for resolutions that there are not, and DeviceError where the device's limits are too low.
        """
        raise NotImplementedError

    @property
    def traversal_buffers(self) -> Mapping[str, Bindable]:
        """Buffers by block name that kernels which include TRAVERSAL need, those of the last build."""
        return self._traversal_buffers

    @property
    def traversal_defines(self) -> dict[str, object]:
        """Defines of kernels which include TRAVERSAL."""
        one_sided: dict[str, object] = {"ONE_SIDED_TRIANGLES": 1} if self._has_one_sided else {}
        has_emitters = self._instanced is not None and self._instanced.has_emitters
        targets: dict[str, object] = {"INSTANCED_EMITTERS": 1} if has_emitters else {}
        return {"TRAVERSAL": self.shader, **one_sided, **targets}

    @property
    def lean_traversal_defines(self) -> dict[str, object]:
        """Defines of kernels which include TRAVERSAL and have few storage blocks left for it: traversal_defines, where
        the structure does with these blocks."""
        return self.traversal_defines

    @property
    def has_instances(self) -> bool:
        """True where rays place instances in the world, and the structure has two levels."""
        return self._instanced is not None

    def trace(
        self, rays: moderngl.Buffer, hits: moderngl.Buffer, active: ActivePaths, paths: HitPaths = HitPaths.CAMERA
    ) -> None:
        """Find the nearest hits of the active paths' Ray records; writes Hit records. ``paths``: whose they are.

        A hit at just maximum_distance counts, one at distance 0 does not. Where nothing is hit,
        triangle is NO_TRIANGLE and the rest without meaning.
        """
        self._trace("acceleration/trace.comp", {"Rays": rays, "Hits": hits}, active, paths)
        self.gather_hits(hits, active, paths)

    def gather_hits(self, hits: moderngl.Buffer, active: ActivePaths, paths: HitPaths) -> None:
        """Make world triangles of hits (HIT) on instances, for all that reads these."""
        self._gather(hits, HitNumbers.HITS, active, paths)

    def gather_lights(self, triangles: moderngl.Buffer, active: ActivePaths) -> None:
        """Make world triangles of the emissive triangles (uint) of instances that active paths' shadow rays go to."""
        self._gather(triangles, HitNumbers.LIGHTS, active, HitPaths.LIGHT)

    def gather_sources(self, rays: moderngl.Buffer, active: ActivePaths, paths: HitPaths) -> None:
        """Make world triangles of the triangles of instances that active paths' rays (RAY) come from."""
        self._gather(rays, HitNumbers.SOURCES, active, paths)

    def _gather(self, numbers: moderngl.Buffer, kind: HitNumbers, active: ActivePaths, paths: HitPaths) -> None:
        if self._instanced is not None:
            self._instanced.gather_hits(numbers, kind, active, paths, self.traversal_buffers)

    def first_hit(self, paths: HitPaths) -> int:
        """The first hit triangle of a list of paths, for kernels that trace; 0 without instances."""
        return 0 if self._instanced is None else self._instanced.hits.of_paths[paths]

    def occluded(
        self,
        rays: moderngl.Buffer,
        targets: moderngl.Buffer,
        visibility: moderngl.Buffer,
        active: ActivePaths,
        linking: Mapping[str, moderngl.Buffer] | None = None,
    ) -> None:
        """Write a uint for the Ray record of each active path: 1 where trace would hit nothing, else 0.

        targets: of each, the triangle that the ray goes to, which does not count, or NO_TRIANGLE; uint.
        linking: the buffers Contributions and LightLinks, where these say what may be in a ray's way.
        """
        kernel = "acceleration/occluded_linked.comp" if linking else "acceleration/occluded.comp"
        buffers = {"Rays": rays, "LightTriangles": targets, "Visibility": visibility, **(linking or {})}
        self._trace(kernel, buffers, active)

    def shadow_hits(
        self,
        rays: moderngl.Buffer,
        targets: moderngl.Buffer,
        hits: moderngl.Buffer,
        active: ActivePaths,
        linking: Mapping[str, moderngl.Buffer] | None = None,
    ) -> None:
        """Find the nearest hits of shadow rays as trace does, of what counts for occluded."""
        kernel = "acceleration/shadow_hits_linked.comp" if linking else "acceleration/shadow_hits.comp"
        buffers = {"Rays": rays, "LightTriangles": targets, "Hits": hits, **(linking or {})}
        self._trace(kernel, buffers, active, HitPaths.SHADOW)
        self.gather_hits(hits, active, HitPaths.SHADOW)

    def _trace(
        self, kernel: str, buffers: Mapping[str, moderngl.Buffer], active: ActivePaths, paths: HitPaths | None = None
    ) -> None:
        program = self._library.compute(kernel, self.traversal_defines)
        parameters = {"first_hit": self.first_hit(paths)} if paths is not None else None
        active.run(program, {**self.traversal_buffers, **buffers}, parameters)
