# SPDX-License-Identifier: GPL-3.0-or-later
"""The Raycast node against Cycles of Blender 5.2, which bpy here has not: raycast.json keeps what measure_raycast.py
found there."""

import json
from pathlib import Path

import bpy
import numpy as np
import pytest

from rppm_addon.blender.export import export_scene
from rppm_addon.scene import AttributeDomain, Link, MeshAttribute, NodeGraph

from ..features.measure import MOST_WRONG, VALUES, WRONG
from .raycast_cases import CASES, COLORS, INCOMING, INSIDE, RESOLUTION, build, colors

MEASURED = json.loads((Path(__file__).parent / "raycast.json").read_text(encoding="utf-8"))["radiance"]


def scaled(graph: NodeGraph, value: Link, scale: float, offset: object) -> Link:
    options = {"operation": "MULTIPLY_ADD"}
    return graph.add("vector_math", "vector", options=options, vector=value, vector_001=(scale,) * 3, vector_002=offset)


def graph_of(case: dict) -> NodeGraph:
    """Return the node graph that the exporter makes of the case's nodes."""
    graph, inputs = NodeGraph(), {"length": case.get("length", 1.0)}
    if case.get("direction") == INCOMING:
        inputs["direction"] = scaled(graph, graph.add("new_geometry", "incoming"), -1.7, (0.0,) * 3)
    elif "direction" in case:
        inputs["direction"] = case["direction"]
    if case.get("position") == INSIDE:
        normal, position = (graph.add("new_geometry", name) for name in ("normal", "position"))
        inputs["position"] = scaled(graph, normal, -0.05, position)
    output = case["output"].lower().replace(" ", "_")
    options = {"only_local": case.get("only_local", False)}
    found = graph.add("raycast", output, options=options, **inputs)
    if case["output"].startswith(COLORS):
        triangle, barycentrics = (Link(found.node, name) for name in ("hit_triangle", "hit_barycentrics"))
        member = "alpha" if case["output"].endswith("Alpha") else "color"
        found = graph.add("cast_attribute", member, attribute=COLORS, triangle=triangle, barycentrics=barycentrics)
    shown = scaled(graph, found, case.get("scale", 1.0), (case.get("offset", 0.0),) * 3)
    graph.surface = graph.add("emission", "emission", color=shown)
    return graph


SHORT = {"through", "color"}


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[] if name in SHORT else [pytest.mark.long]) for name in CASES]
)
def test_rays_find_what_they_find_in_cycles(renderer, name):
    """Pixel by pixel, as there is no noise; where an edge runs through a pixel's middle it may go either way."""
    _, net = build()
    net.output(net.emission((1.0, 1.0, 1.0)))
    scene = export_scene(bpy.context.evaluated_depsgraph_get())
    scene.materials[0].graph = graph_of(CASES[name])
    for mesh in scene.meshes:
        mesh.attributes[COLORS] = MeshAttribute(AttributeDomain.CORNER, colors(len(mesh.corner_vertices)))
    scene.settings = scene.settings.with_values(**VALUES)
    rppm = renderer.render(scene).frame.combined[..., :3]
    cycles = np.array(MEASURED[name]).reshape(RESOLUTION, RESOLUTION, 3)
    wrong = (np.abs(rppm - cycles).max(axis=-1) > WRONG * max(cycles.max(), 1.0)).mean()
    print(f"{name}: pixels that differ {wrong:.2%}")
    assert wrong <= MOST_WRONG and cycles.std() > 0.05
