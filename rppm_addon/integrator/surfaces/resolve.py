# SPDX-License-Identifier: GPL-3.0-or-later
"""Hits become closures in one batched pass (DIRT's deferred fetch)."""

import enum
import struct
from dataclasses import dataclass

import moderngl
import numpy as np

from ...gl.buffer_sets import BufferSet, Part, StorageBuffer
from ...gl.buffers.constants import Constants
from ...gl.buffers.records import Record
from ...gl.buffers.storage_blocks import StorageBlock
from ...gl.context.context import Context
from ...gl.programs.program import Bindable, ComputeProgram
from ...gl.programs.programs import ProgramLibrary
from ...gl.programs.sources import CompileError
from ...materials.compiler.compiled_graph import NEUTRAL_TEXT, NodeRayCounts
from ...materials.tables import MaterialTables, first_line
from ...scene.scene import Scene
from ..acceleration.acceleration_structure import AccelerationStructure
from ..common.active_paths import ActivePaths
from ..common.records.camera_paths import CAMERA_PATH
from ..common.records.closures import CLOSURE
from ..common.records.photon_paths import PHOTON_PATH
from .geometry import Geometry
from .node_rays import NodeRays
from .surface_attributes import SurfaceAttributes

StorageBlock("HitOrder", "uint hit_order[];")
"""Numbers of hits by the program that evaluates their material (shaders/surfaces/resolve/ranges.glsl)."""
StorageBlock("AovValues", "float aov_values[];")
"""Values that AOV Output nodes have written, for each path of a band."""


_PARAMETERS = Record(
    "ResolveParameters",
    world_to_camera="mat4",
    window="vec4",
    world_origin="vec3",
    seed="uint",
    iteration="uint",
    segment="uint",
    program="uint",
    path_kind="uint",
    camera_stride="uint",
    camera_flags="uint",
    camera_depth="uint",
    photon_depth="uint",
    camera_bounce_counts="uint",
    camera_straight_length="uint",
    photon_stride="uint",
    photon_flags="uint",
    attribute_count="uint",
    orthographic="uint",
    pixel_size="float",
    has_adjoint_queries="uint",
    ray_stride="uint",
    ray_level="uint",
    ray_levels="uint",
    dropped_caustics="uint",
    camera_least_pdf="uint",
    camera_lit_from="uint",
    filter_pdf_scale="float",
    gathered_alpha="float",
    specular_alpha="float",
)


class _PathKind(enum.IntEnum):
    """Kinds of paths whose hits are resolved."""

    NONE = 0
    CAMERA = 1
    PHOTON = 2
    SHADOW = 3


@dataclass(frozen=True)
class CameraPaths:
    """Buffers of the camera paths whose hits are resolved, and of the AOVs that their nodes write."""

    paths: moderngl.Buffer
    """CAMERA_PATH."""
    aovs: moderngl.Buffer
    """AovValues."""


_RANGE_SIZE = 8
"""Words of a program's range of the hits."""
Constants("Ranges", RANGE_SIZE=_RANGE_SIZE)
Constants("PathKinds", PATH_OF=_PathKind)
_STAGE = "surfaces/resolve/resolve.comp"
ADJOINT_SEGMENT_OFFSET = 64
"""Number that is added to a segment for random numbers of hits that are seen from where photons go."""
Constants("AdjointSegments", ADJOINT_SEGMENT_OFFSET=ADJOINT_SEGMENT_OFFSET)


def _inserts(text: str) -> dict[str, str]:
    return {"materials/generated.glsl": text}


def has_stand_in(library: ProgramLibrary, text: str) -> bool:
    """Whether the program of a material's GLSL is still to be compiled in the background (see ProgramLibrary)."""
    return library.has_stand_in(_STAGE, _inserts(text))


class Resolve(BufferSet):
    """Rays and their hits to closures: the hits are ordered by program, and each program resolves its own."""

    remedy = "lower the resolution or the photons per iteration"
    _order = StorageBuffer("hits by material", "uint")
    _surface_attributes = Part(SurfaceAttributes)
    _node_rays = Part(NodeRays)

    def __init__(self, context: Context, library: ProgramLibrary) -> None:
        super().__init__(context, library)
        self._library = library
        self._count = library.compute("surfaces/resolve/count.comp")
        self._order_hits = library.compute("surfaces/resolve/order.comp")
        self._programs: list[ComputeProgram] = []
        self._ray_counts: list[NodeRayCounts] = []
        self._ray_stride = 0
        """NODE_RAY records of each hit: the most that any program asks for."""
        self._casts_rays = False
        """Whether nodes ask for rays that begin anywhere."""
        self._traversal: AccelerationStructure | None = None
        self._buffers: dict[str, Bindable] = {}
        self._parameters: dict[str, object] = {}

    @property
    def has_terminators(self) -> bool:
        """Whether any instance has an offset of its shadow terminator."""
        return self._surface_attributes.has_terminators

    def build(self, scene: Scene, geometry: Geometry, materials: MaterialTables) -> None:
        """Take a scene whose geometry and materials are built; programs that are not known yet are compiled.
        What nodes read of the camera follows by set_view.

        A program that the driver refuses is replaced by that of a gray surface, with a warning in scene.warnings.
        Raises DeviceError when the device cannot hold the attributes.
        """
        for text in materials.programs:
            self._library.expect(_STAGE, _inserts(text))
        self._programs = [self._program(text, scene, materials) for text in materials.programs]
        self._ray_counts = [materials.programs[text].rays for text in materials.programs]
        self._ray_stride = max((counts.places for counts in self._ray_counts), default=0)
        self._casts_rays = any(counts.casts for counts in self._ray_counts)
        self._traversal = None
        self._surface_attributes.build(scene, geometry, materials.attribute_names)
        self._buffers = {
            **geometry.blocks,
            **geometry.mesh_blocks,
            **self._surface_attributes.blocks,
            **materials.blocks,
        }

    def set_accelerator(self, traversal: AccelerationStructure) -> None:
        """Take what rays of nodes run through; from a build until then such nodes find nothing."""
        self._traversal = traversal
        if self._ray_stride:
            self.expect_rays()

    def expect_rays(self, casts: bool = False) -> None:
        """Have the program made that answers nodes which ask for rays, after set_accelerator; casts: also for such as
        begin anywhere."""
        if self._traversal is not None:
            self._node_rays.program(self._traversal, self._casts_rays or casts)

    def set_view(self, scene: Scene) -> None:
        """Take the camera that nodes may ask about, where the world is, and the seed of random choices."""
        camera = scene.camera
        self._parameters = {
            "world_to_camera": np.linalg.inv(camera.matrix),
            "window": camera.window,
            "orthographic": camera.orthographic,
            "pixel_size": camera.pixel_size,
            "world_origin": scene.world_offset,
            "seed": scene.settings.seed,
            "dropped_caustics": scene.settings.dropped_caustics,
            "filter_pdf_scale": scene.settings.filter_pdf_scale,
            "gathered_alpha": scene.settings.gathered_alpha,
            "specular_alpha": scene.settings.specular_roughness**2,
            "attribute_count": self._surface_attributes.count,
            "camera_stride": CAMERA_PATH.size // 4,
            "camera_flags": CAMERA_PATH.offset("flags") // 4,
            "camera_straight_length": CAMERA_PATH.offset("straight_length") // 4,
            "camera_depth": CAMERA_PATH.offset("depth") // 4,
            "camera_least_pdf": CAMERA_PATH.offset("least_pdf") // 4,
            "camera_lit_from": CAMERA_PATH.offset("lit_from") // 4,
            "camera_bounce_counts": CAMERA_PATH.offset("bounce_counts") // 4,
            "photon_stride": PHOTON_PATH.size // 4,
            "photon_flags": PHOTON_PATH.offset("flags") // 4,
            "photon_depth": PHOTON_PATH.offset("depth") // 4,
        }

    def _program(self, text: str, scene: Scene, materials: MaterialTables) -> ComputeProgram:
        try:
            return self._library.compute(_STAGE, inserts=_inserts(text))
        except CompileError as error:
            for name in materials.programs[text].names:
                reason = first_line(error)
                scene.warn(f'Material "{name}": the driver does not compile its nodes ({reason}); it is gray')
            return self._library.compute(_STAGE, inserts=_inserts(NEUTRAL_TEXT))

    def run(
        self,
        rays: moderngl.Buffer,
        hits: moderngl.Buffer,
        closures: moderngl.Buffer,
        active: ActivePaths,
        iteration: int,
        segment: int,
        camera_paths: CameraPaths | None = None,
        photon_paths: moderngl.Buffer | None = None,
        has_adjoint_queries: bool = False,
    ) -> None:
        """Fill the closures of active paths; inactive rays and misses give closures without a triangle.

        From the paths, nodes and objects read what kind of rays these are; without any, all is seen and the rays
        are of no kind. has_adjoint_queries: the same hits are seen once more, from where photons go; what chance
        decides is decided anew.
        """
        self._resolve(
            {
                "Rays": rays,
                "Hits": hits,
                "Closures": closures,
                "PathFlags": camera_paths.paths if camera_paths else photon_paths or rays,
                "AovValues": camera_paths.aovs if camera_paths else closures,  # without camera paths none are written
            },
            active,
            {
                "iteration": iteration,
                "segment": segment,
                "has_adjoint_queries": has_adjoint_queries,
                "path_kind": _PathKind.CAMERA if camera_paths else _PathKind.PHOTON if photon_paths else _PathKind.NONE,
            },
        )

    def shadow_rays(
        self,
        rays: moderngl.Buffer,
        hits: moderngl.Buffer,
        closures: moderngl.Buffer,
        contributions: moderngl.Buffer,
        active: ActivePaths,
        iteration: int,
        segment: int,
    ) -> None:
        """Fill the closures of what active shadow rays meet, as run does.

        contributions: vec4 of each ray; the last component tells rays along the reflections of mirrors
        (shaders/common/light_sets.glsl), which surfaces see as glossy rays.
        """
        self._resolve(
            {"Rays": rays, "Hits": hits, "Closures": closures, "PathFlags": contributions, "AovValues": closures},
            active,
            {
                "iteration": iteration,
                "segment": segment,
                "has_adjoint_queries": False,
                "path_kind": _PathKind.SHADOW,
            },
        )

    def _resolve(self, blocks: dict[str, moderngl.Buffer], active: ActivePaths, extra: dict[str, object]) -> None:
        buffers = {**self._buffers, **blocks}
        parameters = {**self._parameters, **extra, "ray_stride": 0, "ray_level": 0, "ray_levels": 0}
        closures = blocks["Closures"]

        # A list of paths is laid out as the order of a single program's hits.
        order = active.buffer if len(self._programs) == 1 else self._order_by_program(buffers, active)
        ordered = {**buffers, "HitOrder": order}
        packed = bytearray(_PARAMETERS.pack({**parameters, "program": 0}))
        for number, program in enumerate(self._programs):
            arguments = 4 * (_RANGE_SIZE * number + 4)
            if self._ray_counts[number].levels:
                places = closures.size // CLOSURE.size * self._ray_stride
                with_rays = {**ordered, "NodeRays": self._node_rays.require(places)}
                of_program = {**parameters, "program": number}
                of_program |= self._trace_node_rays(program, order, arguments, with_rays, of_program)
                program.run_indirect(order, arguments, with_rays, of_program)
            else:
                struct.pack_into("<I", packed, _PARAMETERS.offset("program"), number)
                program.run_indirect(order, arguments, ordered, bytes(packed))

    def _trace_node_rays(
        self,
        program: ComputeProgram,
        order: moderngl.Buffer,
        arguments: int,
        buffers: dict[str, Bindable],
        parameters: dict,
    ) -> dict[str, int]:
        """Have the nodes of a program ask and be answered, level by level; returns further parameters for it."""
        if self._traversal is None:
            return {"ray_stride": 0}
        counts = self._ray_counts[parameters["program"]]
        extra = {"ray_stride": self._ray_stride, "ray_levels": counts.levels}
        traced = {name: parameters[name] for name in ("seed", "iteration", "program")}
        traced["segment"] = parameters["segment"] + (ADJOINT_SEGMENT_OFFSET if parameters["has_adjoint_queries"] else 0)
        for level in range(counts.levels):
            extra["ray_level"] = level
            program.run_indirect(order, arguments, buffers, {**parameters, **extra})
            self._node_rays.trace(
                self._node_rays.program(self._traversal, self._casts_rays),
                order,
                arguments,
                {**buffers, **self._traversal.traversal_buffers},
                counts,
                {**traced, "ray_stride": self._ray_stride, "ray_level": level},
            )
        return {**extra, "ray_level": counts.levels}

    def _order_by_program(self, buffers: dict[str, Bindable], active: ActivePaths) -> moderngl.Buffer:
        self._order.require_items(_RANGE_SIZE * len(self._programs) + active.capacity)
        self._order.buffer.clear(4 * _RANGE_SIZE * len(self._programs))
        buffers = {**buffers, "HitOrder": self._order.buffer, "ActivePaths": active.buffer}
        active.run(self._count, buffers, {"count": len(self._programs)})
        active.run(self._order_hits, buffers)
        return self._order.buffer
