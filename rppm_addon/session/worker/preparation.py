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
    """Compiles the programs that pictures of a scene need, with a single thread at a lower priority.

    Programs of other sessions come first. Only the settings and the materials' graphs of the scene matter.
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
        """Whether there are programs to link; the background compiler works independently."""
        return self._slices is not None

    def run_slice(self) -> None:
        """Link some programs."""
        try:
            if self._slices is not None and next(self._slices, self) is not self:
                return
        except (BrokenPipeError, DeviceLostError):
            raise
        except Exception:  # the render that follows reports it
            self._context.finish()  # raises DeviceLostError if that is the cause
            log.info("not all is prepared", exc_info=True)
        self._slices = None
        self._send("prepared")

    def _prepare(self, scene: Scene) -> Iterator[None]:
        self._library.hurry(False)
        self._library.graph_defines = scene.color_space.defines
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
        """Link no more programs. Those that are being compiled are finished, as other sessions may use them."""
        self._slices = None
