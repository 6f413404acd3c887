# SPDX-License-Identifier: GPL-3.0-or-later
"""First looks at the scenes of a session, until there is a rendered picture."""

import logging
import math

import numpy as np

from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ...gl.programs.sources import ShaderError
from ...integrator.pilot_view import enlarged
from ...integrator.progressive import ProgressivePhotonMapper
from ...integrator.viewport.first_look import FirstLook
from ...scene.errors import DeviceLostError, RppmError
from ...scene.scene import Scene
from .resolution_scaler import at_level

log = logging.getLogger(__name__)

MOST_PIXELS = 1 << 22
"""Most pixels of a first look. Larger pictures are enlarged from it, as its memory is not part of the forecast."""


class FirstLooks:
    """Draws scenes with the geometry that the session's mapper has on the device, or will need there anyway."""

    def __init__(self, context: Context, library: ProgramLibrary) -> None:
        self._context = context
        self._library = library
        self._look: FirstLook | None = None

    def of(self, mapper: ProgressivePhotonMapper) -> FirstLook:
        """Return the first look that uses a mapper's geometry. It is the same one until release() is called."""
        if self._look is None:
            built, acceleration = mapper.device_scene, mapper.device_scene.acceleration
            self._look = FirstLook(
                self._context,
                self._library,
                built.geometry,
                built.displacement.as_known,
                built.centering.centered,
                lambda scene, columns: acceleration.instanced_members(acceleration.settled(scene), columns),
            )
        return self._look

    def shows_parts_of(self, scene: Scene) -> bool:
        """Whether a scene can be drawn with the parts of the scene before that are on the device."""
        return self._look is not None and self._look.shows_parts_of(scene)

    def draw(self, scene: Scene, mapper: ProgressivePhotonMapper) -> np.ndarray | None:
        """Return a picture as FirstLook.draw does, or None for a panorama and for a scene that cannot be drawn.

        The render that follows reports what is wrong with such a scene. Raises DeviceLostError.
        """
        if scene.camera.panorama is not None:
            return None
        width, height = scene.camera.resolution
        level = min(1.0, math.sqrt(MOST_PIXELS / (width * height)))
        try:
            return enlarged(self.of(mapper).draw(at_level(scene, level)), width, height)
        except DeviceLostError:
            raise
        except (RppmError, ShaderError):
            log.info("there is no first look", exc_info=True)
            return None

    def release(self) -> None:
        """Free the buffers, except the mapper's geometry."""
        if self._look is not None:
            self._look.release()
            self._look = None
