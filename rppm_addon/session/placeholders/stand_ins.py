# SPDX-License-Identifier: GPL-3.0-or-later
"""Stand-ins: materials that are rendered in place of others whose programs are compiled in the background."""

import dataclasses
import time

from ...gl.programs.programs import ProgramLibrary
from ...materials.placeholders.stand_in import stand_in_graph
from ...scene.materials import Material
from ...scene.scene import Scene
from .known_programs import MaterialProgram, programs_of

FEWEST_PROGRAMS = 2
"""Fewest programs to compile for which stand-ins are used, as they need a program as well."""
EXCHANGE_SECONDS = 4.0
"""Time between two exchanges of stand-ins for materials: the picture begins anew with each."""


class StandIns:
    """Replaces materials in a viewport until their programs are compiled. Final renders wait for the programs."""

    def __init__(self, library: ProgramLibrary) -> None:
        self._library = library
        self._programs: dict[int, tuple[Material, tuple[MaterialProgram, ...]]] = {}
        """Materials of the scene with their programs, by the materials' identity."""
        self._made: dict[int, tuple[Material, Material]] = {}
        """Materials of the scene with their stand-ins, likewise."""
        self._waited_for: set[MaterialProgram] = set()
        """Programs that are not compiled yet."""
        self._used = False
        """Whether the program of the stand-ins is compiled."""
        self._exchanged_at = 0.0

    @property
    def count(self) -> int:
        """Number of programs in whose place stand-ins are rendered."""
        return len(self._waited_for)

    def replace(self, scene: Scene) -> Scene:
        """Return the scene with stand-ins for materials whose programs are compiled in the background from now on."""
        self._library.graph_defines = scene.color_space.defines
        self._programs = {id(material): (material, self._programs_of(material)) for material in scene.materials}
        self._made = {key: made for key, made in self._made.items() if key in self._programs}
        programs = dict.fromkeys(program for _, own in self._programs.values() for program in own)
        self._waited_for = {program for program in programs if program.has_stand_in(self._library)}
        self._exchanged_at = time.perf_counter()
        if not self._used and len(self._waited_for) < FEWEST_PROGRAMS:
            self._waited_for = set()
        if not self._waited_for:
            return scene
        self._used = True
        return self.as_shown(scene)

    def as_shown(self, scene: Scene) -> Scene:
        """Return the scene with the stand-ins of the last call of ``replace``, if it has the same materials."""
        if not self._waited_for or any(id(material) not in self._programs for material in scene.materials):
            return scene
        return dataclasses.replace(scene, materials=[self._shown(material, scene) for material in scene.materials])

    def _programs_of(self, material: Material) -> tuple[MaterialProgram, ...]:
        known = self._programs.get(id(material))
        return programs_of(material) if known is None else known[1]

    def _shown(self, material: Material, scene: Scene) -> Material:
        if self._waited_for.isdisjoint(self._programs[id(material)][1]):
            return material
        if id(material) not in self._made:
            graph = stand_in_graph(material.graph, scene.images)
            self._made[id(material)] = (
                material,
                dataclasses.replace(material, graph=graph, abbe_number=None, on_round_shapes=False),
            )
        return self._made[id(material)][1]

    @property
    def due(self) -> bool:
        """Whether to begin anew with the programs that are ready: all of them, or some after a while."""
        if not self._waited_for:
            return False
        left = sum(program.has_stand_in(self._library) for program in self._waited_for)
        late = time.perf_counter() - self._exchanged_at >= EXCHANGE_SECONDS
        return left == 0 or (late and left < len(self._waited_for))
