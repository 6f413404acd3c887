# SPDX-License-Identifier: GPL-3.0-or-later
"""The materials' programs with which the renderer's process has rendered."""

from dataclasses import dataclass

from ...gl.programs.programs import ProgramLibrary
from ...integrator.surfaces import displaced_vertices, resolve
from ...materials.compiler.compiled_graph import NEUTRAL_TEXT, GraphError
from ...materials.compiler.compiler import compile_displacement, compile_graph
from ...materials.tables import MaterialTables, default_material
from ...scene.materials import Material
from ...scene.scene import Scene

MOST_TRIANGLES = 100_000
"""Most triangles of a scene without a first look: building a larger one takes longer than the first look."""


@dataclass(frozen=True)
class MaterialProgram:
    """A program of a material."""

    text: str
    """GLSL."""
    displaces: bool = False
    """Whether the program moves vertices; others resolve hits."""

    def has_stand_in(self, library: ProgramLibrary) -> bool:
        """Whether the program is being compiled in the background (ProgramLibrary.has_stand_in)."""
        return (displaced_vertices if self.displaces else resolve).has_stand_in(library, self.text)


class KnownPrograms:
    """Programs of materials that the process has rendered with. Other programs are the same for all scenes, or follow
    from these materials."""

    def __init__(self) -> None:
        self._programs: set[MaterialProgram] = set()

    def add(self, materials: MaterialTables) -> None:
        """Record the materials of a picture that was rendered."""
        self._programs.update(MaterialProgram(text) for text in materials.programs)
        self._programs.update(MaterialProgram(graph.text, True) for graph in materials.displacing.values())

    def cover(self, scene: Scene) -> bool:
        """Whether the first picture of a scene takes little longer than a first look: there is nothing to compile and
        little to build."""
        triangles = [mesh.triangle_count for mesh in scene.meshes]
        known = range(len(triangles))
        if sum(triangles[instance.mesh] for instance in scene.instances if instance.mesh in known) > MOST_TRIANGLES:
            return False
        needed = {program for material in (*scene.materials, default_material()) for program in programs_of(material)}
        if any(mesh.dicing is not None for mesh in scene.meshes):  # may become far more than MOST_TRIANGLES
            return False
        return bool(self._programs) and self._programs.issuperset(needed)


def programs_of(material: Material) -> tuple[MaterialProgram, ...]:
    """Return the programs that a material is rendered with."""
    try:
        text = compile_graph(
            material.graph,
            abbe_number=material.abbe_number,
            on_round_shapes=material.on_round_shapes,
            corrects_bump=material.corrects_bump,
        ).text
    except GraphError:
        text = NEUTRAL_TEXT
    if material.graph.displacement is None:
        return (MaterialProgram(text),)
    try:
        return MaterialProgram(text), MaterialProgram(compile_displacement(material.graph).text, displaces=True)
    except GraphError:  # it displaces nothing
        return (MaterialProgram(text),)
