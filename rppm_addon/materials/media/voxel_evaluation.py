# SPDX-License-Identifier: GPL-3.0-or-later
"""Node graphs of volumes, evaluated at voxels."""

from collections.abc import Mapping

import numpy as np

from ...gl.buffer_sets import BufferSet, StorageBuffer
from ...gl.buffers.records import Record
from ...gl.context.context import Context
from ...gl.programs.program import Bindable
from ...gl.programs.programs import ProgramLibrary
from ...scene.scene import Scene
from .bricks import BRICK_VOXELS, Lattice

Record(
    "EvaluateVoxelsParameters",
    world_to_camera="mat4",
    window="vec4",
    to_world0="vec4",
    to_world1="vec4",
    to_world2="vec4",
    world_origin="vec3",
    count="uint",
    voxels="uvec3",
    first_brick="uint",
    instance="uint",
    first_constant="uint",
    attribute_count="uint",
    orthographic="uint",
    pixel_size="float",
    ray_length="float",
)
WORLD = 0xFFFFFFFF
"""In place of the number of an instance: voxels of the world's volume."""
_CHUNK = 512
"""Bricks that are evaluated at once."""


class VoxelEvaluator(BufferSet):
    """Evaluates node graphs at the voxels of a lattice."""

    _emissions = StorageBuffer("emission by voxel", "vec4")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: object = None) -> None:
        super().__init__(context, library, sizes)
        self._library = library

    def run(
        self,
        text: str,
        first_constant: int,
        buffers: Mapping[str, Bindable],
        scene: Scene,
        lattice: Lattice,
        instance: int,
        matrix: np.ndarray,
        attributes: Mapping[str, Bindable],
    ) -> np.ndarray:
        """(bricks, BRICK_VOXELS, 3) float32 emission of a graph at the voxels of a lattice, 0 beyond its ends.

        text: the compiled graph; first_constant: where its constants start in the buffer MaterialData; instance: whose
        object the nodes read, or WORLD; matrix: (4, 4) from the lattice's space to the world; attributes: the blocks of
        VolumeAttributes. Raises CompileError where the driver does not compile the text.
        """
        camera, view, origin = scene.camera, scene.camera.matrix.copy(), scene.world_offset
        to_world = np.asarray(matrix, np.float64) @ np.linalg.inv(lattice.to_grid)
        to_world[:3, 3] += 0.5 * to_world[:3, :3].sum(axis=1)  # voxel i has its center at i + 0.5
        if instance == WORLD:  # whose nodes are asked about places in Blender's world
            view[:3, 3] += origin
            to_world[:3, 3] += origin
            origin = np.zeros(3)
        program = self._library.compute("materials/evaluate_voxels.comp", inserts={"materials/generated.glsl": text})
        bricks = int(np.prod(lattice.bricks))
        self._emissions.require_items(min(bricks, _CHUNK) * BRICK_VOXELS)
        bound = {**buffers, **attributes, "Emissions": self._emissions.buffer}
        parts = []
        for first in range(0, bricks, _CHUNK):
            count = min(_CHUNK, bricks - first) * BRICK_VOXELS
            parameters = {
                "world_to_camera": np.linalg.inv(view), "window": camera.window, "world_origin": origin,
                "to_world0": to_world[0], "to_world1": to_world[1], "to_world2": to_world[2],
                "count": count, "voxels": lattice.voxels, "first_brick": first,
                "instance": instance, "first_constant": first_constant,
                "attribute_count": 0, "orthographic": camera.orthographic, "pixel_size": 0.0, "ray_length": 0.0,
            }  # fmt: skip
            program.run(count, bound, parameters)
            values = self._emissions.read(np.dtype("<f4"), 4 * count)
            parts.append(values.reshape(-1, BRICK_VOXELS, 4)[..., :3])
        return np.concatenate(parts)
