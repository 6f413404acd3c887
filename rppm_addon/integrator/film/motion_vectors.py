# SPDX-License-Identifier: GPL-3.0-or-later
"""The pass Vector: how what is seen moves from the frame before and to the next one."""

import dataclasses

import moderngl
import numpy as np

from ...gl.buffer_sets import BufferSet, ComputeShader, Part
from ...gl.buffers.records import Record
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ...scene.camera import Camera
from ...scene.motion import Shutter
from ...scene.moving_scene import MovingScene
from ...scene.passes import VECTOR
from ..camera_paths.importons import Importons
from ..common.band import Band
from ..common.film_buffers import FilmBuffer
from ..common.iteration import Iteration
from ..common.stage_sizes import StageSizes
from ..device_scene.stage_context import StageContext
from ..surfaces.placements import Placements
from .neighbor_placements import NeighborPlacements

_CAMERAS = ("", "_before", "_after")
Record(
    "MotionVectorParameters",
    **{f"world_to_camera{when}": "mat4" for when in _CAMERAS},
    **{f"window{when}": "vec4" for when in _CAMERAS},
    resolution="vec2",
    segment="uint",
)


class MotionVectors(BufferSet):
    """Means over the iterations that found a surface, 16 bytes a pixel. Without Scene.neighbors all vectors are 0."""

    remedy = "switch off the pass Vector"
    _vectors = FilmBuffer("motion vectors", "vec4")
    _neighbors = Part(NeighborPlacements)
    _program = ComputeShader("film/motion_vectors/add.comp")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        self._uploaded: tuple[Shutter, Placements] | None = None
        """Shutter and placements of the scene whose neighboring frames are uploaded, or None."""
        self._cameras: tuple[Camera, Camera] | None = None
        """Cameras of the previous frame and of the next one, or None."""

    @classmethod
    def is_needed(cls, sizes: StageSizes) -> bool:
        """BufferSet.is_needed: for the pass Vector."""
        return any(entry.name == VECTOR for entry in sizes.passes)

    def add(
        self,
        context: StageContext,
        importons: Importons,
        pass_counts: moderngl.Buffer,
        band: Band,
        iteration: Iteration,
        segment: int,
    ) -> None:
        """Add the first surfaces that the camera paths of a band have found in a segment, before passes.comp counts
        them in ``pass_counts``."""
        if not self.is_on:
            return
        self._follow(context)
        if self._cameras is None:
            if iteration.number_in_film == 1 and band.first_pixel == segment == 0:
                self._vectors.clear()
            return
        camera = context.scene.camera
        cameras = dict(zip(_CAMERAS, (camera, *self._cameras), strict=True))
        importons.active.run(
            self._program,
            {
                **context.blocks,
                **importons.blocks,
                **context.geometry.mesh_blocks,
                **self.blocks,
                "PassCounts": pass_counts,
                "MotionVectors": self._vectors.of(band),
            },
            {
                **{f"world_to_camera{when}": np.linalg.inv(seen.matrix) for when, seen in cameras.items()},
                **{f"window{when}": seen.window for when, seen in cameras.items()},
                "resolution": (camera.width, camera.height),
                "segment": segment,
            },
        )

    def _follow(self, context: StageContext) -> None:
        """Place what moves in the neighboring frames, unless it is there; no cameras are known where nothing is known
        of these."""
        placements, neighbors = context.geometry.placements, context.scene.neighbors
        if (
            neighbors is not None
            and self._uploaded is not None
            and self._uploaded[0] is neighbors
            and self._uploaded[1] is placements
        ):
            return
        self._uploaded = self._cameras = None
        if neighbors is None:
            return
        moving = MovingScene(dataclasses.replace(context.scene, shutter=neighbors))
        before, after = moving.at(0.0), moving.at(1.0)
        self._neighbors.take(context.geometry, neighbors, (before, after))
        self._cameras = before.camera, after.camera
        self._uploaded = neighbors, placements

    def read(self) -> dict[str, np.ndarray]:
        """The pass by name, (height, width, 4) float32 pixels: X and Y from here to where it was in the frame before,
        Z and W from where it will be in the next one to here."""
        if not self.is_on:
            return {}
        return {VECTOR: self._vectors.read(np.float32, 4)}

    def restore(self, vectors: np.ndarray) -> None:
        """Take what ``read`` gave."""
        self._vectors.upload(np.asarray(vectors, np.float32))
