# SPDX-License-Identifier: GPL-3.0-or-later
"""The media that paths begin in: around the camera and the lights."""

import math

import numpy as np

from ...gl.buffer_sets import StorageBuffer
from ...gl.buffers.records import Record
from ...gl.buffers.storage_blocks import StorageBlock
from ...gl.context.context import Context
from ...gl.programs.program import Bindable, ComputeProgram
from ...gl.programs.programs import ProgramLibrary
from ...scene.scene import Scene
from ..camera_paths.importons import Importons
from ..common.active_paths import ActivePaths
from ..common.iteration import Iteration
from ..common.stage import Stage
from ..common.stage_sizes import StageSizes
from ..device_scene.stage_context import StageContext
from ..photons.photons import Photons
from ..surfaces.geometry import finite_bounds
from ..surfaces.placements import placed_boxes

MEDIUM_BOX = Record("MediumBox", low="vec3", unused0="uint", high="vec3", unused1="uint")
"""Lowest and highest coordinates of surfaces with a medium inside, meters."""
_MAX_BOXES = 32
"""Boxes that points are looked for in; what is more lies in the last together."""
StorageBlock("MediaOfSources", "uint media_of_sources[];")
"""The media at the middle of each light, and at the camera, as paths carry them."""
Record("FindMediaParameters", camera_position="vec3", box_count="uint", boxes=(MEDIUM_BOX, _MAX_BOXES))
Record(
    "EnterMediaParameters",
    camera_position="vec3",
    box_count="uint",
    boxes=(MEDIUM_BOX, _MAX_BOXES),
    has_camera="uint",
)

_FLATTEST = 0.25
"""Least extent of the box around what there is in the world's medium, over the largest."""


class Media(Stage):
    """Paths begin in the media that surround the camera or their light (shaders/media/crossings.glsl).

    Their programs are compiled when there is a box, as they depend on the acceleration structure.
    """

    memory_group = "media"
    remedy = "use fewer objects with volumes"
    _of_sources = StorageBuffer("media of lights and the camera", "uint", block="MediaOfSources")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        self._library = library
        self._has_texels = sizes.has_texels
        self._defines = {"MEDIA": 1} | ({"EMISSIVE_MEDIA": 1} if sizes.features.has_emissive_media else {})
        self._scene: Scene | None = None
        self._boxes = MEDIUM_BOX.zeros(_MAX_BOXES)
        self._box_count = 0
        self.volume = 0.0
        """Volume in which media lie, m^3: that of the boxes around them, or of the scene."""
        self.reach = 0.0
        """Radius, meters, of the scene, or of the cube that is as large as the media where the scene is smaller."""

    @classmethod
    def is_needed(cls, sizes: StageSizes) -> bool:
        """Stage.is_needed: where materials or the world have a volume."""
        return sizes.features.has_media

    def enter_photons(self, context: StageContext, photons: Photons, iteration: Iteration) -> None:
        """Have photons that have just left the lights begin in the media there."""
        if self.is_on:
            self._find_media(context, iteration)
        if self._box_count:
            self._enter(context, photons.active, photons.blocks, "media/enter_photons.comp")

    def enter_camera_paths(self, context: StageContext, importons: Importons) -> None:
        """Have camera paths that have just begun do so in the media around the camera."""
        if self._box_count:
            self._enter(context, importons.active, importons.blocks, "media/enter_camera_paths.comp")

    def _find_media(self, context: StageContext, iteration: Iteration) -> None:
        """Find where media are, and what is in them, for a new scene."""
        if self._scene is context.scene and iteration.number > 1:
            return
        self._scene = context.scene
        boxes = _boxes(context.scene, context.materials.media.materials)
        self.volume = _volume(context, boxes)
        self.reach = max(context.geometry.radius, 0.5 * math.sqrt(3.0) * math.cbrt(self.volume))
        self._box_count = len(boxes)
        if self._box_count:
            self._find(context, boxes)

    def _find(self, context: StageContext, boxes: np.ndarray) -> None:
        self._boxes["low"][: len(boxes)], self._boxes["high"][: len(boxes)] = boxes[:, 0], boxes[:, 1]
        lights = len(context.lights.table)
        self._of_sources.require_items(lights + 1)
        program = self._compile("media/find.comp", context)
        program.run(lights + 1, {**self._inputs(context), **self.blocks}, self._parameters(context))

    def _enter(self, context: StageContext, active: ActivePaths, blocks: dict[str, Bindable], kernel: str) -> None:
        program = self._compile(kernel, context)
        parameters = {**self._parameters(context), "has_camera": not self._has_texels}
        active.run(program, {**self._inputs(context), **self.blocks, **blocks}, parameters)

    def _inputs(self, context: StageContext) -> dict[str, Bindable]:
        return {**context.blocks, **context.geometry.mesh_blocks}

    def _compile(self, kernel: str, context: StageContext) -> ComputeProgram:
        hits = {"HITS": "media/two_levels"} if context.acceleration.has_instances else {}
        return self._library.compute(kernel, context.acceleration.lean_traversal_defines | self._defines | hits)

    def _parameters(self, context: StageContext) -> dict[str, object]:
        position = tuple(map(float, context.scene.camera.matrix[:3, 3]))
        return {"camera_position": position, "box_count": self._box_count, "boxes": self._boxes}


def _volume(context: StageContext, boxes: np.ndarray) -> float:
    """Volume of boxes (n, 2, 3), but not more than that of the scene; where the world's medium scatters, that of the
    scene with its camera and lights, m^3, which may lie in one plane."""
    low, high = context.geometry.bounds_low, context.geometry.bounds_high
    around_everything = context.materials.media.world_scatters
    if around_everything:
        seen = [context.scene.camera.matrix[:3, 3], *(light.matrix[:3, 3] for light in context.scene.lights)]
        low, high = np.minimum(low, np.min(seen, axis=0)), np.maximum(high, np.max(seen, axis=0))
        extents = np.maximum(high - low, _FLATTEST * max(float(np.max(high - low)), 1e-3))
        return float(np.prod(extents))
    whole = float(np.prod(np.maximum(high - low, 1e-3)))
    extents = boxes[:, 1].astype(np.float64) - boxes[:, 0]
    return min(float(np.prod(extents, axis=1).sum()), whole)


def _boxes(scene: Scene, materials: frozenset[int]) -> np.ndarray:
    """(n, 2, 3) float32 boxes, low and high, around the instances with any of the materials, meters."""
    found: dict[int, tuple[np.ndarray, np.ndarray] | None] = {}
    low, high = [], []
    for instance in scene.instances:
        if materials.isdisjoint(instance.materials):
            continue
        if instance.mesh not in found:
            found[instance.mesh] = finite_bounds(scene.meshes[instance.mesh].positions)
        bounds = found[instance.mesh]
        if bounds is None:
            continue
        lows, highs, good = placed_boxes(instance.matrix[None], np.array([bounds]))
        low += list(lows[good])
        high += list(highs[good])
    boxes = np.stack([low, high], axis=1) if low else np.zeros((0, 2, 3))
    if len(boxes) > _MAX_BOXES:
        rest = boxes[_MAX_BOXES - 1 :]
        united = np.stack([rest[:, 0].min(axis=0), rest[:, 1].max(axis=0)])
        boxes = np.concatenate([boxes[: _MAX_BOXES - 1], united[None]])
    return boxes.astype(np.float32)
