# SPDX-License-Identifier: GPL-3.0-or-later
"""Which scenes the programs of this process serve already."""

from ...materials.compiler import NEUTRAL_TEXT, GraphError, compile_displacement, compile_graph
from ...materials.tables import MaterialTables, default_material
from ...scene.materials import Material
from ...scene.scene import Scene

MOST_TRIANGLES = 100_000
"""With more, building the scene takes longer than a first look, compiled or not."""


class KnownPrograms:
    """The texts of materials that frames were rendered with; the other programs are the same for all scenes."""

    def __init__(self) -> None:
        self._texts: set[str] = set()

    def add(self, materials: MaterialTables) -> None:
        """A frame was rendered with these."""
        self._texts.update(materials.programs)
        self._texts.update(graph.text for graph in materials.displacing.values())

    def cover(self, scene: Scene) -> bool:
        """Whether the first frame of a scene takes little more than a first look at it: nothing is to be compiled and
        little to be built."""
        triangles = [mesh.triangle_count for mesh in scene.meshes]
        known = range(len(triangles))
        if sum(triangles[instance.mesh] for instance in scene.instances if instance.mesh in known) > MOST_TRIANGLES:
            return False
        displacements = [text for material in scene.materials if (text := _displacement_of(material)) is not None]
        if displacements and any(mesh.dicing is not None for mesh in scene.meshes):  # into how many triangles?
            return False
        materials = *scene.materials, default_material()
        return bool(self._texts) and self._texts.issuperset([*map(text_of, materials), *displacements])


def text_of(material: Material) -> str:
    """The GLSL that a material is rendered with."""
    try:
        return compile_graph(
            material.graph, abbe_number=material.abbe_number, on_round_shapes=material.on_round_shapes
        ).text
    except GraphError:
        return NEUTRAL_TEXT


def _displacement_of(material: Material) -> str | None:
    """The GLSL that moves the vertices of its faces; None where nothing does."""
    if material.graph.displacement is None:
        return None
    try:
        return compile_displacement(material.graph).text
    except GraphError:
        return None
