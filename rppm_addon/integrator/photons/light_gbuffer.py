# SPDX-License-Identifier: GPL-3.0-or-later
"""DirectPhotonHits by rasterization: light G-buffers, in which photons find their first hits.

After the direct photon hit pass of the paper (section 3), but photons keep the rays that they leave by. The scene is
rasterized conservatively as the light sees it: a texel lists all triangles that such rays can meet up to its horizon, a
little behind the first of them. A photon tests those of its texel. A hit before the horizon is the nearest one, and
where a texel is empty there is none; what its texel does not settle is traced. So both routes give the same hits, bit
for bit.

Point lights and spots have six views, the faces of a cube, or one where their cone is narrow; suns have one, from
so far off that their light is nearly parallel there. The margin by which texels are widened holds small lights'
extent and suns' disks.
"""

import math
from collections.abc import Mapping

import moderngl
import numpy as np

from ...gl.buffer_sets import BufferSet, ComputeShader, StorageBuffer
from ...gl.buffers.records import Record
from ...gl.buffers.storage_blocks import StorageBlock
from ...gl.context.context import Context
from ...gl.programs.program import Bindable, DrawProgram
from ...gl.programs.programs import ProgramLibrary
from ..common.active_paths import ActivePaths
from ..common.require import require
from ..lights.light_records import LightShape
from ..surfaces.geometry import Geometry

LIGHT_VIEW = Record(
    "LightView",
    center="vec3",
    margin="float",
    right="vec3",
    tangent="float",
    up="vec3",
    tip_distance="float",
    forward="vec3",
    min_depth="float",
)
"""View of a light through a window whose half extent at depth 1 is ``tangent``. Depths begin at the tip,
``tip_distance`` before the center; ``margin`` is how far texels are widened; nearer than ``min_depth`` float rounding
leaves no precision to directions. Lengths in meters."""

Record(
    "LightGBufferParameters",
    side="uint",
    view_count="uint",
    triangle_count="uint",
    job_capacity="uint",
    columns="uint",
    rows="uint",
)
Record("FirstHitsParameters", side="uint", count="uint")

LIGHT_TEXEL = Record("LightTexel", depth_complement="uint", count="uint", end="uint")
"""Complement of the bits of the depth where its first triangle ends, 0 where there is none; how many triangles begin
before the horizon, and where their numbers end in the list of all (where they are few enough to be listed)."""

StorageBlock("TexelTriangles", "uint texel_triangles[];")
_COUNTS = Record("LightGBufferCounts", jobs="uint", triangles="uint", unused0="uint", unused1="uint")

MAX_LIGHTS = 16
"""Maximum number of lights that have views. The lights with the most photons have them; photons of the others are
traced."""

_COARSEST_SIDE, _FINEST_SIDE, _TEXELS = 128, 512, 1 << 19
"""Texels along a view's side, and of all views where these allow it."""
_MAX_TESTS = 1 << 24
"""Views times triangles: beyond this only the first light has views."""
_PICTURE_SIDE = 4096
_WIDEST_MARGIN = 1.0 / 128.0
"""Largest margin of a useful view, as a fraction of the scene's radius. Lights with more extent have no useful view."""
_WIDEST_CONE = math.radians(60.0)
"""Half a spot's angle up to which it has one view."""
_ROUNDING = 2.0**-19
"""Margin for rounding, as a fraction of the farthest distance: a few times the rounding of positions."""
_SUN_DISTANCE = 2000.0
"""Distance of a sun view's tip from the scene's center, in radii of the scene."""


def _view_axes(direction: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Right, up and forward."""
    aside = np.eye(3)[np.argmin(np.abs(direction))]
    right = np.cross(direction, aside)
    right /= np.linalg.norm(right)
    return right, np.cross(right, direction), direction


def _faces() -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """The cube's faces along +x, -x, +y, -y, +z, -z."""
    axes = np.eye(3)
    return [(axes[(k + 1) % 3], axes[(k + 2) % 3], sign * axes[k]) for k in range(3) for sign in (1.0, -1.0)]


def light_views(light: np.void, scene_center: np.ndarray, scene_radius: float) -> np.ndarray:
    """The views (LIGHT_VIEW) that hold all rays of a LIGHT record's photons: six, one, or none."""
    kind = int(light["kind"])
    if kind == LightShape.SUN:
        tip = _SUN_DISTANCE * scene_radius
        sine = math.sqrt(max(0.0, 1.0 - float(light["cosine_cone"]) ** 2))
        views, axes_of_views = LIGHT_VIEW.zeros(1), [_view_axes(light["normal"].astype(np.float64))]
        views["center"], views["tip_distance"], views["tangent"] = scene_center, tip, 1.01 * scene_radius / tip
        # Over the scene's depth rays leave their texel's cone so far.
        slope = sine / max(float(light["cosine_cone"]), 1e-3) + 1.0 / _SUN_DISTANCE
        views["margin"] = scene_radius * (1.02 * slope + _ROUNDING)
        views["min_depth"] = 0.5 * tip
    elif kind in (LightShape.POINT, LightShape.SPOT):
        cone = math.acos(max(-1.0, 1.0 - float(light["spread_scale"]))) if kind == LightShape.SPOT else math.pi
        narrow = cone < _WIDEST_CONE
        views = LIGHT_VIEW.zeros(1 if narrow else 6)
        axes_of_views = [_view_axes(light["normal"].astype(np.float64))] if narrow else _faces()
        tangent = max(1.001 * math.tan(cone), 1e-3) if narrow else 1.0
        farthest = float(np.linalg.norm(light["position"] - scene_center)) + scene_radius
        rounding = _ROUNDING * farthest
        views["center"], views["tangent"] = light["position"], tangent
        views["margin"] = 1.01 * math.hypot(1.0, tangent) * float(light["radius"]) + rounding
        views["min_depth"] = 16.0 * rounding
    else:
        return LIGHT_VIEW.zeros(0)
    views["right"], views["up"], views["forward"] = (np.array(axes) for axes in zip(*axes_of_views))
    return views[views["margin"] <= _WIDEST_MARGIN * scene_radius]


def views_side(views: int) -> int:
    """Texels along each view's side, a power of two."""
    side = 1 << (max(math.isqrt(_TEXELS // views), 1).bit_length() - 1)
    return min(max(side, _COARSEST_SIDE), _FINEST_SIDE)


class LightGBuffer(BufferSet):
    """The views of a scene's point lights, spots and suns. Buffers are kept between scenes and grow with need."""

    remedy = "trace the first photon hits"
    _views = StorageBuffer("light views", LIGHT_VIEW, block="LightViews")
    _ranges = StorageBuffer("views by light", "uvec2", block="LightViewRanges")
    _texels = StorageBuffer("light G-buffer", LIGHT_TEXEL, block="LightTexels")
    _triangles = StorageBuffer("triangles of the light G-buffer", "uint", block="TexelTriangles")
    _jobs = StorageBuffer("light G-buffer jobs", "uvec4", header=_COUNTS, block="LightJobs")
    _list_jobs = ComputeShader("photons/light_gbuffer/list_jobs.comp")
    _allocate = ComputeShader("photons/light_gbuffer/allocate.comp")
    _first_hits = ComputeShader("photons/light_gbuffer/first_hits.comp")

    def __init__(self, context: Context, library: ProgramLibrary) -> None:
        super().__init__(context, library)
        self._context = context
        self._nearest = library.draw("photons/light_gbuffer/jobs.vert", "photons/light_gbuffer/nearest.frag")
        self._count = library.draw("photons/light_gbuffer/jobs.vert", "photons/light_gbuffer/count.frag")
        self._list = library.draw("photons/light_gbuffer/jobs.vert", "photons/light_gbuffer/list.frag")
        self._framebuffer: moderngl.Framebuffer | None = None
        self._parameters: dict[str, int] = {}
        self._side = 0

    def build(self, lights: np.ndarray, scene_center: np.ndarray, scene_radius: float, geometry: Geometry) -> int:
        """Rasterize what the lights (LIGHT records with their photon counts) see; how many views they have.

        scene_radius: of the sphere that photons from suns come through, meters. Raises DeviceError.
        """
        ranges, found, count = np.zeros((len(lights), 2), np.uint32), [LIGHT_VIEW.zeros(0)], 0
        for index in np.argsort(-lights["photon_count"].astype(np.int64), kind="stable")[:MAX_LIGHTS]:
            views = light_views(lights[index], scene_center, scene_radius)
            if count and (count + len(views)) * geometry.triangle_count > _MAX_TESTS:
                break
            ranges[index] = count, len(views)
            found.append(views)
            count += len(views)
        self._ranges.upload(ranges)
        if count:
            self._side = views_side(count)
            self._views.upload(np.concatenate(found))
            self._texels.require_items(self._side**2 * count)
            self._texels.clear()
            self._rasterize(count, geometry)
        return count

    def _rasterize(self, views: int, geometry: Geometry) -> None:
        """Fill the texels: where the first triangles end, how many there are up to the horizon, and which."""
        columns = min(views, _PICTURE_SIDE // self._side)
        rows = -(-views // columns)
        self._parameters = {
            "side": self._side, "view_count": views, "triangle_count": geometry.triangle_count, "job_capacity": 0,
            "columns": columns, "rows": rows,
        }  # fmt: skip
        size = (self._side * columns, self._side * rows)
        if self._framebuffer is None or self._framebuffer.size != size:
            if self._framebuffer is not None:
                self.disown(self._framebuffer)
            self._framebuffer = self.own(self._context.moderngl.empty_framebuffer(size))
        jobs = self._find_jobs(views, geometry)
        self._draw(self._nearest, jobs, geometry)
        self._draw(self._count, jobs, geometry)
        self._allocate.run(views * self._side**2, self.blocks, self._parameters)
        self._triangles.require_items(int(self._jobs.read(_COUNTS.dtype, 1)["triangles"][0]))
        self._draw(self._list, jobs, geometry)

    def _find_jobs(self, views: int, geometry: Geometry) -> int:
        """List where triangles may be seen; how many such jobs there are."""
        jobs = 5 * geometry.triangle_count // 4
        while True:
            self._jobs.require_items(jobs)
            capacity = self._jobs.capacity
            self._jobs.write(_COUNTS.zeros(1))
            self._list_jobs.run(
                views * geometry.triangle_count,
                {**geometry.blocks, **self.blocks},
                self._parameters | {"job_capacity": capacity},
            )
            jobs = int(self._jobs.read(_COUNTS.dtype, 1)["jobs"][0])
            if jobs <= capacity:
                return jobs

    def _draw(self, program: DrawProgram, jobs: int, geometry: Geometry) -> None:
        blocks = {**geometry.blocks, **self.blocks}
        program.draw(require(self._framebuffer), 6 * jobs, blocks, self._parameters)

    def find(
        self,
        blocks: Mapping[str, Bindable],
        rays: moderngl.Buffer,
        hits: moderngl.Buffer,
        count: int,
        left: ActivePaths,
    ) -> None:
        """Write the hits (HIT) of photons' rays (RAY) that their texels settle, and list the others in ``left``.

        blocks: those of the scene (StageContext.blocks).
        """
        left.begin(count)
        self._first_hits.run(
            count,
            {**blocks, **self.blocks, "Rays": rays, "Hits": hits, "KeptPaths": left.buffer},
            {"side": self._side, "count": count},
        )
