# SPDX-License-Identifier: GPL-3.0-or-later
"""A session of the renderer's process in which nothing is rendered: programs are compiled ahead of it."""

import dataclasses
from collections.abc import Callable, Iterator

from ...gl.context import Context
from ...gl.programs import ProgramLibrary
from ...integrator.progressive import ProgressivePhotonMapper
from ...integrator.surfaces.resolve import has_stand_in
from ...scene.errors import DeviceLostError, RppmError
from ...scene.scene import Scene
from .known_programs import text_of


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
        except DeviceLostError:
            raise
        except RppmError:  # whoever renders says so
            pass
        self._slices = None
        self._send("prepared")

    def _prepare(self, scene: Scene) -> Iterator[None]:
        self._library.hurry(False)
        mapper = ProgressivePhotonMapper(self._context, self._library)
        try:
            yield
            mapper.link_programs(dataclasses.replace(scene, materials=[]))
        finally:
            mapper.release()
        for text in dict.fromkeys(text_of(material) for material in scene.materials):
            yield
            has_stand_in(self._library, text)

    def release(self) -> None:
        """Do nothing more here; what is being compiled is of use to others."""
        self._slices = None
