# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes of numbers, vectors and colors that are more than their sockets and options."""

import bpy

from .....scene import Link
from .graphs import GraphExporter, handles, snake_case
from .links import Path
from .tables import curve_table, extrapolates, ramp_table


@handles("VALUE")
def _value(exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path) -> float:
    return exporter.stored(output)


@handles("RGB")
def _rgb(exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path) -> tuple:
    return exporter.stored(output)


@handles("INPUT_SCENE_TIME")  # of Blender 5.2
def _scene_time(exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path) -> float:
    exporter.context.owner_reads += 1  # materials do not count as changed with the frame
    scene = next(owner for owner in exporter.context.owners if isinstance(owner, bpy.types.Scene))
    frame = scene.frame_current_final
    return frame if output.identifier == "Frame" else frame * scene.render.fps_base / scene.render.fps


@handles("MIX")
def _mix(exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path) -> Link | None:
    """A kind for each type of data."""
    kinds = {"FLOAT": "mix_float", "VECTOR": "mix_vector", "RGBA": "mix_color"}
    if node.data_type not in kinds:
        kind = node.bl_rna.properties["data_type"].enum_items[node.data_type].name
        exporter.warn(node, f"has the Data Type {kind}, which is not rendered")
        return None
    kind = kinds[node.data_type]
    if kind == "mix_vector" and node.factor_mode == "NON_UNIFORM":
        kind = "mix_vector_non_uniform"
    return exporter.add(kind, node, path, snake_case(output.identifier))


@handles("MAP_RANGE")
def _map_range(exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path) -> Link:
    kind = "map_range_vector" if node.data_type == "FLOAT_VECTOR" else "map_range"
    return exporter.add(kind, node, path, snake_case(output.identifier))


@handles("RGBTOBW")
def _rgb_to_bw(exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path) -> Link:
    return exporter.add("rgb_to_bw", node, path, "val")


@handles("VALTORGB")
def _ramp(exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path) -> Link:
    ramp = node.color_ramp
    # Cycles steps also where Blender interpolates because the ramp's colors are HSV.
    options = {"constant": ramp.interpolation == "CONSTANT"}
    name = snake_case(output.identifier)
    return exporter.add("val_to_rgb", node, path, name, options=options, table=ramp_table(ramp))


@handles("CURVE_RGB", "CURVE_VEC", "CURVE_FLOAT")
def _curve(exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path) -> Link:
    kind = {"CURVE_RGB": "rgb_curve", "CURVE_VEC": "vector_curve", "CURVE_FLOAT": "float_curve"}[node.type]
    table = curve_table(node.mapping, 1 if kind == "float_curve" else 3)
    options = {"extrapolate": extrapolates(node.mapping)}
    return exporter.add(kind, node, path, snake_case(output.identifier), options=options, table=table)


@handles("NORMAL")
def _normal(exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path) -> Link:
    inputs = {"direction": tuple(node.outputs["Normal"].default_value)}
    return exporter.add("normal", node, path, snake_case(output.identifier), inputs=inputs)


@handles("LIGHT_FALLOFF")
def _light_falloff(exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path) -> Link:
    inputs = {"ray_length": exporter.graph.add("light_path", "ray_length")}
    return exporter.add("light_falloff", node, path, snake_case(output.identifier), inputs=inputs)
