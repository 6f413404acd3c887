# SPDX-License-Identifier: GPL-3.0-or-later
"""Parameters of an iteration that many programs read: one uniform block, as Cycles has its KernelData."""

import moderngl
import numpy as np

from ...gl.buffer_sets import BufferSet, StorageBuffer
from ...gl.buffers.records import Record
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ...scene.scene import Scene
from ...scene.settings import DirectLight
from ..common.iteration import Iteration
from ..density_estimation.radii import RADIUS_PARAMETERS, Radii, shrinkage
from ..lights.lights import LIGHT_PARAMETERS, Lights
from ..surfaces.geometry import Geometry

_SETTINGS = {
    "max_bounces": "uint",
    "transparent_max_bounces": "uint",
    "camera_bounces": "uint",
    "photon_bounces": "uint",
    "volume_bounces": "uint",
    "film_transparent": "uint",
    "film_transparent_roughness": "float",
    "bounce_limits": "uvec4",
    "dropped_caustics": "uint",
    "clamp_direct": "float",
    "clamp_indirect": "float",
}
"""Members that are attributes of RenderSettings, by name and type."""

ITERATION_PARAMETERS = Record(
    "IterationParameters",
    number="uint",
    number_in_film="uint",
    seed="uint",
    **LIGHT_PARAMETERS,
    world_group="uint",
    photon_flux="float",
    limits_bounces="uint",
    **_SETTINGS,
    specular_alpha="float",
    final_gather="uint",
    next_event="uint",
    has_round_shapes="uint",
    mirrors_see_others="uint",
    orthographic_camera="uint",
    most_transparent="float",
    shrinkage="float",
    **RADIUS_PARAMETERS,
)
"""Members of the uniform block Iteration (shaders/common/iteration.glsl).

``number``, ``number_in_film`` and ``seed`` are those of Iteration. ``photon_flux`` is the mean
flux of all photons, W. ``limits_bounces`` tells whether any light has bounce limits of its own, ``next_event`` whether
shadow rays bring direct light, ``mirrors_see_others`` whether glossy rays see what stops no shadow rays, or the other
way round. ``shrinkage`` is r_i / r_1 of Eq. 2. The other members are settings, or members that the
lights and the radii declare. ``most_transparent`` is how much a surface may transmit that passes show.
"""


class IterationBlock(BufferSet):
    """The uniform block Iteration on the device."""

    _parameters = StorageBuffer("iteration parameters", ITERATION_PARAMETERS, 1)

    def __init__(self, context: Context, library: ProgramLibrary) -> None:
        super().__init__(context, library)
        self._values: dict[str, object] = {}

    @property
    def buffer(self) -> moderngl.Buffer:
        """The block, an ITERATION_PARAMETERS record."""
        return self._parameters.buffer

    def write(self, scene: Scene, geometry: Geometry, lights: Lights, iteration: Iteration) -> None:
        """Take an iteration; its radii are 0 until write_radii is called."""
        settings = scene.settings
        self._values = {
            **lights.parameters,
            "number": iteration.number,
            "number_in_film": iteration.number_in_film,
            "seed": iteration.seed,
            "world_group": lights.world_group,
            "photon_flux": lights.photon_flux,
            "limits_bounces": lights.limits_bounces,
            **{name: getattr(settings, name) for name in _SETTINGS},
            "specular_alpha": settings.specular_roughness**2,
            "final_gather": settings.use_final_gather,
            "next_event": settings.direct_light is DirectLight.RAYS,
            "has_round_shapes": geometry.has_round_shapes,
            "mirrors_see_others": geometry.columns.mirrors_see_others,
            "orthographic_camera": scene.camera.orthographic and scene.camera.panorama is None,
            "most_transparent": 1.0 - scene.pass_alpha_threshold if scene.pass_alpha_threshold > 0.0 else np.inf,
            "shrinkage": shrinkage(max(iteration.number, 1), settings.alpha),
            **dict.fromkeys(RADIUS_PARAMETERS, 0.0),
        }
        self._write()

    def write_number_in_film(self, number: int) -> None:
        """Take the number of the iteration among those of the film, for the bands of rows to come."""
        if number != self._values["number_in_film"]:
            self._values["number_in_film"] = number
            self._write()

    def write_radii(self, radii: Radii) -> None:
        """Take the radii of the iteration, once its photons are known."""
        self._values |= radii.parameters
        self._write()

    def _write(self) -> None:
        self.buffer.write(ITERATION_PARAMETERS.pack(self._values))
