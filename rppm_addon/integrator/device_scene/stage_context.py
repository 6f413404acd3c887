# SPDX-License-Identifier: GPL-3.0-or-later
"""Context that every stage of an iteration works with."""

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ...gl.context.timers import StageTimers
from ...gl.programs.program import Bindable
from ...materials.tables import MaterialTables
from ...scene.scene import Scene
from ...scene.settings import RenderSettings
from ..acceleration.acceleration_structure import AccelerationStructure
from ..common.iteration import Iteration
from ..lights.lights import Lights
from ..surfaces.geometry import Geometry
from ..surfaces.resolve import Resolve
from .iteration_parameters import IterationBlock


@dataclass(frozen=True)
class StageContext:
    """The scene on the device at the iteration's moment, with resolve, timers and storage blocks."""

    scene: Scene
    geometry: Geometry
    materials: MaterialTables
    lights: Lights
    acceleration: AccelerationStructure
    """Acceleration structure that rays are traced through."""
    center: np.ndarray
    """Center of the deep cubemap, and of the cubemaps that photons are splatted into, (3,) meters."""
    resolve: Resolve
    timers: StageTimers
    iteration_block: IterationBlock
    blocks: Mapping[str, Bindable]
    """Storage blocks and textures of the scene, and of the stages once with_blocks has added them, by name."""

    def begin(self, iteration: Iteration) -> None:
        """Have programs read the parameters of an iteration, but for its radii."""
        self.iteration_block.write(self.scene, self.geometry, self.lights, iteration)

    def with_blocks(self, blocks: Mapping[str, Bindable]) -> "StageContext":
        """The same context, in which stages find more storage blocks."""
        return dataclasses.replace(self, blocks={**self.blocks, **blocks})

    @property
    def settings(self) -> RenderSettings:
        """Settings of the scene."""
        return self.scene.settings

    @property
    def gathers(self) -> bool:
        """Whether camera paths go on from the first surface that stores photons to gather indirect light."""
        return self.settings.use_final_gather and self.settings.camera_bounces > 0
