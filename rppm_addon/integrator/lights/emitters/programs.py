# SPDX-License-Identifier: GPL-3.0-or-later
"""Programs that sample emissive triangles."""

from ....gl.programs.program import ComputeProgram
from ....gl.programs.programs import ProgramLibrary
from .instances import INSTANCED_EMITTERS, EmitterInstances


class EmitterProgram:
    """A compute program that is another one where rays place emissive instances in the world."""

    def __init__(self, library: ProgramLibrary, path: str) -> None:
        """Raises ShaderError as ProgramLibrary.compute does."""
        self._library, self._path = library, path
        self._scene_defines = library.scene_defines
        self._one_level = library.compute(path)
        self._two_levels: ComputeProgram | None = None

    def of(self, instances: EmitterInstances) -> ComputeProgram:
        """Return the program for a scene with these emissive instances."""
        if not instances.are_there:
            return self._one_level
        if self._two_levels is None:
            with self._library.defining(self._scene_defines):
                self._two_levels = self._library.compute(self._path, INSTANCED_EMITTERS)
        return self._two_levels
