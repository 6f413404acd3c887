# SPDX-License-Identifier: GPL-3.0-or-later
"""Which scenes the programs of this process serve already."""

from dataclasses import dataclass

from ...gl.programs import ProgramLibrary
from ...integrator.surfaces import displaced_vertices, resolve
from ...materials.compiled_graph import NEUTRAL_TEXT, GraphError
from ...materials.compiler import compile_displacement, compile_graph
from ...materials.tables import MaterialTables, default_material
from ...scene.materials import Material
from ...scene.scene import Scene

MOST_TRIANGLES = 100_000
"""With more, building the scene takes longer than a first look, compiled or not."""


@dataclass(frozen=True)
class MaterialProgram:
    """A program of a material's own."""

    text: str
    """GLSL."""
    displaces: bool = False
    """Whether it moves vertices, and does not resolve hits."""

    def has_stand_in(self, library: ProgramLibrary) -> bool:
        """Whether it is still to be compiled, and is, in the background (see ProgramLibrary)."""
        return (displaced_vertices if self.displaces else resolve).has_stand_in(library, self.text)


class KnownPrograms:
    """Programs of materials that frames were rendered with; the others are the same for all scenes, or follow from what
    these materials are of."""

    def __init__(self) -> None:
        self._programs: set[MaterialProgram] = set()

    def add(self, materials: MaterialTables) -> None:
        """A frame was rendered with these."""
        self._programs.update(MaterialProgram(text) for text in materials.programs)
        self._programs.update(MaterialProgram(graph.text, True) for graph in materials.displacing.values())

    def cover(self, scene: Scene) -> bool:
        """Whether the first frame of a scene takes little more than a first look at it: nothing is to be compiled and
        little to be built."""
        triangles = [mesh.triangle_count for mesh in scene.meshes]
        known = range(len(triangles))
        if sum(triangles[instance.mesh] for instance in scene.instances if instance.mesh in known) > MOST_TRIANGLES:
            return False
        needed = {program for material in (*scene.materials, default_material()) for program in programs_of(material)}
        is_displaced = any(program.displaces for program in needed)
        if is_displaced and any(mesh.dicing is not None for mesh in scene.meshes):  # into how many triangles?
            return False
        return bool(self._programs) and self._programs.issuperset(needed)


def programs_of(material: Material) -> tuple[MaterialProgram, ...]:
    """Return the programs that a material is rendered with."""
    try:
        text = compile_graph(
            material.graph, abbe_number=material.abbe_number, on_round_shapes=material.on_round_shapes
        ).text
    except GraphError:
        text = NEUTRAL_TEXT
    if material.graph.displacement is None:
        return (MaterialProgram(text),)
    try:
        return MaterialProgram(text), MaterialProgram(compile_displacement(material.graph).text, displaces=True)
    except GraphError:  # it displaces nothing
        return (MaterialProgram(text),)
