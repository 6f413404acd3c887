# SPDX-License-Identifier: GPL-3.0-or-later
"""Values and shaders that tests of materials compare."""

from blender_scenes import export_graph
from node_trees import shaders

RED = (1.0, 0.0, 0.0, 1.0)
OCHRE = (0.5, 0.25, 0.125, 1.0)


def single_shader(scene, material):
    """The only shader of an exported material, and the warnings of the export."""
    graph, warnings = export_graph(scene, material)
    ((node, weight),) = shaders(graph)
    assert weight == 1.0
    return node, warnings
