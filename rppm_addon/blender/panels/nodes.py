# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels that edit what a node tree's output has linked; they show the output that is exported."""

import bpy
from bpy_extras.node_utils import find_node_input

from .base import RppmPanel


class RppmNodePanel(RppmPanel):
    """Mixed into panels that show one input of an output node."""

    owner_name = ""
    """Name of the context's member that has the node tree."""
    input_name = "Surface"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and getattr(context, cls.owner_name, None) is not None

    def draw(self, context: bpy.types.Context) -> None:
        owner = getattr(context, self.owner_name)
        layout = self.layout
        layout.use_property_split = True
        # From 5.0 on materials and worlds always have nodes.
        if (self.owner_name == "light" or bpy.app.version < (5, 0)) and not owner.use_nodes:
            layout.prop(owner, "use_nodes", icon="NODETREE", toggle=True)
            return
        output = owner.node_tree.get_output_node("CYCLES")
        found = None if output is None else find_node_input(output, self.input_name)
        if found is None:
            layout.label(text="No output node", icon="INFO")
        else:
            layout.template_node_view(owner.node_tree, output, found)
