# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's world to a node graph."""

import bpy
import numpy as np

from ...scene import World
from .graphs import GraphExporter
from .images import ImageTable
from .links import node_tree
from .report import Report


def export_world(world: bpy.types.World | None, report: Report, images: ImageTable) -> World:
    """The surroundings; black where the scene has no world."""
    if world is None:
        return World()
    tree = node_tree(world)
    if tree is None:
        return World(radiance=_finite(np.array(world.color, np.float64)))
    owner = f'World "{world.name}"'
    output = tree.get_output_node("CYCLES") or tree.get_output_node("ALL")
    if output is None:
        return World()
    exporter = GraphExporter(owner, report, images)
    if output.inputs["Volume"].is_linked:
        report.warn(f"{owner}: its volume is not rendered yet and is ignored")
    exporter.graph.surface = exporter.shader(output.inputs["Surface"])
    return World(np.ones(3), exporter.graph) if exporter.graph.surface is not None else World()


def _finite(radiance: np.ndarray) -> np.ndarray:
    return np.maximum(np.nan_to_num(radiance, nan=0.0, posinf=0.0, neginf=0.0), 0.0)
