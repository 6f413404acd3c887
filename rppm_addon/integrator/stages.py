# SPDX-License-Identifier: GPL-3.0-or-later
"""What every stage of an iteration works with."""

from dataclasses import dataclass

from ..gl.timers import StageTimers
from ..materials.tables import MaterialTables
from ..scene.settings import RenderSettings
from .deep_cubemap import DeepCubemap
from .emission import Emission
from .geometry import Geometry
from .resolve import Resolve


@dataclass
class Stages:
    """The scene on the GPU and the passes shared by photons and importons."""

    settings: RenderSettings
    geometry: Geometry
    materials: MaterialTables
    emission: Emission
    deep_cubemap: DeepCubemap
    resolve: Resolve
    timers: StageTimers
