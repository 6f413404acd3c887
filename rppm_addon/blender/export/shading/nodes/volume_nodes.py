# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes of volumes."""

import bpy

from .....scene import Link
from .graphs import GraphExporter, handles, kind_name, snake_case
from .links import Path


@handles("VOLUME_ABSORPTION", "VOLUME_SCATTER", "VOLUME_COEFFICIENTS")
def _volume(exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path) -> Link | None:
    return exporter.add(kind_name(node), node, path, "volume") if _is_in_volume(exporter, node) else None


_GRIDS = {
    "color_grid": "Color Attribute",
    "density_grid": "Density Attribute",
    "temperature_grid": "Temperature Attribute",
}
"""Sockets of Principled Volume with the name of the attribute that multiplies an input, by the kind's input for it."""


@handles("PRINCIPLED_VOLUME")
def _principled(exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path) -> Link | None:
    if not _is_in_volume(exporter, node):
        return None
    sockets = {socket.identifier: socket for socket in node.inputs}
    inputs: dict[str, object] = {}
    for grid, socket in _GRIDS.items():
        attribute = exporter.text(sockets[socket], path) if socket in sockets else ""
        if attribute:
            member = "color" if grid == "color_grid" else "fac"
            inputs[grid] = exporter.shared("grid_attribute", member, attribute, exporter.name_of(node))
    return exporter.add("volume_principled", node, path, "volume", inputs=inputs)


@handles("VOLUME_INFO")
def _volume_info(exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path) -> object:
    """Attributes of volumes; surfaces have none."""
    if not exporter.is_volume:
        return 0.0 if output.type == "VALUE" else (0.0, 0.0, 0.0)
    member = "color" if output.identifier == "Color" else "fac"
    return exporter.shared("attribute", member, snake_case(output.identifier), exporter.name_of(node))


def _is_in_volume(exporter: GraphExporter, node: bpy.types.Node) -> bool:
    if not exporter.is_volume:
        exporter.warn(node, "is a volume and no surface; it is left out")
    return exporter.is_volume
