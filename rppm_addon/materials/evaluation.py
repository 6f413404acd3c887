# SPDX-License-Identifier: GPL-3.0-or-later
"""Emission of node graphs that belong to no surface: worlds, lights and volumes."""

import enum
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from ..gl.buffer_sets import BufferSet, StorageBuffer
from ..gl.buffers.constants import Constants
from ..gl.buffers.records import Record
from ..gl.buffers.storage_blocks import StorageBlock
from ..gl.context.context import Context
from ..gl.programs.program import Bindable
from ..gl.programs.programs import ProgramLibrary
from ..scene.scene import Scene

Record(
    "EvaluateParameters",
    world_to_camera="mat4",
    window="vec4",
    world_origin="vec3",
    count="uint",
    width="uint",
    height="uint",
    first_row="uint",
    first_constant="uint",
    from_camera="uint",
    attribute_count="uint",
    orthographic="uint",
    pixel_size="float",
    ray_length="float",
    light_position="vec3",
    light_radius="float",
    light_u="vec3",
    light_shape="uint",
    light_v="vec3",
    light_kind="uint",
    light_normal="vec3",
)
StorageBlock("Emissions", "vec4 emissions[];")
"""Emission of a node graph at what it is evaluated at."""

_CHUNK = 1 << 18


class MapShape(enum.IntEnum):
    """Kinds of maps of lights, by what the pixels of a map stand for."""

    NORMALS = 1
    """Normals of a sphere, equirectangular."""
    DIRECTIONS = 2
    """Directions of the light, equirectangular."""
    CONE = 3
    """Directions of the light by where they meet a square before the light."""
    PLACES = 4
    """Places on an area light."""


class LightSurfaceKind(enum.IntEnum):
    """Kinds of lights whose nodes are evaluated."""

    SPHERE = 0
    AREA = 1
    SUN = 2
    SUN_OF_A_WORLD = 3


_WITHOUT_PLACE = {LightSurfaceKind.SUN, LightSurfaceKind.SUN_OF_A_WORLD}
Constants("MapShapes", MAP=MapShape)
Constants("LightSurfaceKinds", LIGHT_SURFACE=LightSurfaceKind)


@dataclass(frozen=True)
class LightSurface:
    """A light before its nodes: vectors (3,) in world space, meters."""

    kind: LightSurfaceKind
    shape: MapShape
    position: np.ndarray
    normal: np.ndarray
    """Unit vector along which it emits."""
    u: np.ndarray
    v: np.ndarray
    """Half extents of an area light; of a CONE, from the middle of the square at distance 1 to its edges."""
    radius: float
    instance: np.ndarray
    """() ShadingInstance record, for nodes that read the light's object."""


class GraphEvaluator(BufferSet):
    """Evaluates node graphs at directions instead of hits."""

    _emissions = StorageBuffer("emission by direction", "vec4")
    _instance = StorageBuffer("object of a light", "vec4")
    _nothing = StorageBuffer("in place of geometry", "uint", 256)
    """Bound for blocks of geometry, which these graphs cannot read."""

    def __init__(self, context: Context, library: ProgramLibrary, sizes: object = None) -> None:
        super().__init__(context, library, sizes)
        self._library = library

    def run(
        self,
        text: str,
        first_constant: int,
        buffers: Mapping[str, Bindable],
        width: int,
        height: int,
        from_camera: bool,
        ray_length: float,
        scene: Scene,
        light_surface: LightSurface | None = None,
    ) -> Iterator[np.ndarray]:
        """Bands of (rows, width, 3) float32 emission in the directions of an equirectangular map, or of a light over
        its map, ``height`` rows in all, from the lowest on.

        text: the compiled graph; first_constant: where its constants start in the buffer MaterialData.
        """
        camera, matrix, origin = scene.camera, scene.camera.matrix.copy(), scene.world_offset
        if light_surface is None or light_surface.kind in _WITHOUT_PLACE:  # directions are asked about, as of places
            matrix[:3, 3] += origin
            origin = np.zeros(3)
        program = self._library.compute("materials/evaluate.comp", inserts={"materials/generated.glsl": text})
        rows = max(1, _CHUNK // width)
        self._emissions.require_items(width * min(rows, height))
        bound = {name: buffers.get(name, self._nothing.buffer) for name in program.blocks}
        bound["Emissions"] = self._emissions.buffer
        names = ("position", "radius", "u", "v", "normal", "shape", "kind")
        light_parameters = {
            f"light_{name}": 0 if light_surface is None else getattr(light_surface, name) for name in names
        }
        if light_surface is not None:
            self._instance.upload(np.atleast_1d(light_surface.instance))
            bound |= {"ShadingInstances": self._instance.buffer} if "ShadingInstances" in bound else {}
        for first_row in range(0, height, rows):
            count = width * min(rows, height - first_row)
            parameters = {
                "world_to_camera": np.linalg.inv(matrix), "window": camera.window, "world_origin": origin,
                "count": count,
                "width": width, "height": height, "first_row": first_row, "first_constant": first_constant,
                "from_camera": from_camera,
                "attribute_count": 0, "orthographic": camera.orthographic, "pixel_size": 0.0,
                "ray_length": ray_length,
                **light_parameters,
            }  # fmt: skip
            program.run(count, bound, parameters)
            found = self._emissions.read(np.dtype("<f4"), 4 * count).reshape(-1, width, 4)[..., :3]
            yield np.nan_to_num(found, nan=0.0, posinf=0.0, neginf=0.0)
