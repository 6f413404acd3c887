# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender materials to weighted lobes."""

import bpy
import numpy as np

from ...scene import Lobe, LobeKind, Material
from .images import ImageTable
from .links import node_tree
from .report import Report
from .shaders import add_lobes
from .values import Evaluator

DEFAULT_COLOR = (0.8, 0.8, 0.8)
"""What Blender shows where a face has no material."""


class MaterialTable:
    """The materials of a scene under export, each exported once."""

    def __init__(self, report: Report, images: ImageTable) -> None:
        self.materials: list[Material] = []
        self._report = report
        self._images = images
        self._indices: dict[int, int] = {}

    def index(self, material: bpy.types.Material | None) -> int:
        """Index of a material, exported now if it is new; None is Blender's grey."""
        # Not session_uid: Blender gives evaluated copies none.
        key = 0 if material is None else material.as_pointer()
        if key not in self._indices:
            if material is None:
                exported = Material("Default", [Lobe(LobeKind.DIFFUSE, color=DEFAULT_COLOR)])
            else:
                exported = export_material(material, self._report, self._images)
            self._indices[key] = len(self.materials)
            self.materials.append(exported)
        return self._indices[key]


def export_material(material: bpy.types.Material, report: Report, images: ImageTable) -> Material:
    """The surface and the interior of a material; what has no counterpart is reported and left out."""
    exported = Material(material.name)
    tree = node_tree(material)
    if tree is None:
        exported.lobes.append(Lobe(LobeKind.DIFFUSE, color=tuple(material.diffuse_color[:3])))
        return exported
    evaluator = Evaluator(f'Material "{material.name}"', report, images)
    output = tree.get_output_node("CYCLES") or tree.get_output_node("ALL")
    if output is None:
        report.warn(f'Material "{material.name}": it has no Material Output node and is black')
        return exported
    for shader in evaluator.shaders(output.inputs["Surface"]):
        add_lobes(exported.lobes, evaluator, shader)
    if output.inputs["Displacement"].is_linked:
        report.warn(f'Material "{material.name}": displacement is not rendered yet and is ignored')
    volume = output.inputs["Volume"]
    if volume.is_linked:
        for shader in evaluator.shaders(volume):
            node, path = shader.node, shader.path
            if node.type == "VOLUME_ABSORPTION":
                density = max(evaluator.scalar(node.inputs["Density"], path), 0.0)
                color = np.clip(evaluator.mean_color(node.inputs["Color"], path), 0.0, 1.0)
                exported.absorption = exported.absorption + shader.weight * density * (1.0 - color)
            else:
                evaluator.warn(node, "is a volume that is not rendered yet and is ignored")
        if not output.inputs["Surface"].is_linked:
            # Only an interior: the boundary itself is not there.
            exported.lobes.append(Lobe(LobeKind.TRANSPARENT))
    return exported
