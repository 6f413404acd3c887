# SPDX-License-Identifier: GPL-3.0-or-later
"""A session of the renderer's process in which nothing is rendered: programs are compiled ahead of it."""

import logging
from collections.abc import Callable, Iterator

from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ...integrator.progressive import ProgressivePhotonMapper
from ...integrator.viewport.pictures import demands_of
from ...scene.errors import DeviceLostError
from ...scene.scene import Scene
from ..placeholders.known_programs import programs_of

log = logging.getLogger(__name__)


class Preparation:
    """Has the programs that pictures of a scene need compiled by a single thread at a lower priority.

    What other sessions need meanwhile comes first. Of the scene only the materials' graphs and the settings count.
    """

    def __init__(self, context: Context, library: ProgramLibrary, send: Callable[..., None]) -> None:
        self._context = context
        self._library = library
        self._send = send
        self._slices: Iterator[None] | None = None

    def show(self, scene: Scene, generation: int, navigating: bool) -> None:
        """Prepare for this scene."""
        self._slices = self._prepare(scene)

    @property
    def busy(self) -> bool:
        """Whether there is something to do here; compiling goes on beside it."""
        return self._slices is not None

    def run_slice(self) -> None:
        """Link some programs."""
        try:
            if self._slices is not None and next(self._slices, self) is not self:
                return
        except (BrokenPipeError, DeviceLostError):
            raise
        except Exception:  # whoever renders says so
            self._context.finish()  # which says so where it is because the device is lost
            log.info("not all is prepared", exc_info=True)
        self._slices = None
        self._send("prepared")

    def _prepare(self, scene: Scene) -> Iterator[None]:
        self._library.hurry(False)
        mapper = ProgressivePhotonMapper(self._context, self._library)
        try:
            yield
            mapper.link_programs(scene, demands_of(scene, 1.0))
        finally:
            mapper.release()
        for material in scene.materials:
            yield
            for program in programs_of(material):
                program.has_stand_in(self._library)

    def release(self) -> None:
        """Do nothing more here; what is being compiled is of use to others."""
        self._slices = None
