# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that trace rays find the same on instances that rays place in the world as on expanded ones, bit for bit."""

import numpy as np
import pytest
import scenes
from rendering import radiance_of
from support.graphs import diffuse_by_node

from rppm_addon.scene import (
    AccelerationStructure,
    AttributeDomain,
    Instance,
    Instancing,
    Light,
    LightKind,
    Link,
    Material,
    MeshAttribute,
    NodeGraph,
    Scene,
)

SAMPLES = 8.0


def casting() -> Material:
    """Has a color by the distance, the normal and the object that a ray meets."""
    graph = NodeGraph()
    found = graph.add("raycast", "hit_normal", length=1.5)
    parts = {"x": Link(found.node, "self_hit"), "y": Link(found.node, "hit_distance")}
    seen = graph.add("vector_math", "vector", vector=graph.add("combine_xyz", "vector", **parts), vector_001=found)
    graph.surface = graph.add("bsdf_diffuse", "bsdf", color=seen)
    return Material("casting", graph)


def tinted() -> Material:
    """Has the color that an attribute has where a ray from above meets something."""
    graph = NodeGraph()
    above = graph.add("vector_math", "vector", vector=graph.add("new_geometry", "position"), vector_001=(0.1, 0.1, 1.0))
    found = graph.add("raycast", "hit_normal", position=above, direction=(0.2, 0.3, -1.0), length=1.5)
    places = {"triangle": Link(found.node, "hit_triangle"), "barycentrics": Link(found.node, "hit_barycentrics")}
    color = graph.add("cast_attribute", "color", attribute="Tint", **places)
    graph.surface = graph.add("bsdf_diffuse", "bsdf", color=color)
    return Material("tinted", graph)


NODES = {
    "occlusion": lambda: diffuse_by_node("ambient_occlusion", "color", samples=SAMPLES, distance=1.0),
    "occlusion by the object": lambda: diffuse_by_node(
        "ambient_occlusion", "color", options={"only_local": True, "inside": True}, samples=SAMPLES, distance=0.2
    ),
    "bevel": lambda: diffuse_by_node("bevel", "normal", samples=SAMPLES, radius=0.3),
    "raycast": casting,
    "attributes of what a raycast meets": tinted,
}


def crowd(surface: Material, instancing: Instancing, structure: AccelerationStructure) -> Scene:
    """Balls, smooth, turned, skewed and mirrored, and boxes with sharp edges, on a floor, all colored by nodes."""
    scene = scenes.scene_of(
        scenes.camera((0, -3, 2), (0, 0, 0.2), 0.6, 24), (scenes.square("floor", 2.0), surface),
        (scenes.sphere("ball", 16, 8), surface), (scenes.box("box"), surface),
        lights=[Light("sun", LightKind.SUN, np.eye(4), np.ones(3))], photons=500, passes=(), camera_path_length=3,
        photon_path_length=3, instancing=instancing, acceleration_structure=structure,
    )  # fmt: skip
    del scene.instances[1:]
    random = np.random.default_rng(7)
    for mesh in scene.meshes:
        values = random.random((len(mesh.positions), 3)).astype(np.float32)
        mesh.attributes["Tint"] = MeshAttribute(AttributeDomain.POINT, values)
    for number in range(24):
        matrix = scenes.placed(*random.uniform((-1.2, -1.0, 0.0), (1.2, 1.4, 0.5)))
        matrix[:3, :3] = random.normal(size=(3, 3)) * 0.1 + np.eye(3) * (0.25 if number % 3 else -0.25)
        own = {"Tint": (0.9, 0.1, 0.2)} if number == 5 else {}
        scene.instances.append(Instance(1 + number % 2, matrix, [1], attributes=own))
    return scene


@pytest.mark.parametrize("structure", [AccelerationStructure.BVH, AccelerationStructure.DEEP_CUBEMAP])
@pytest.mark.parametrize("name", NODES)
def test_nodes_find_the_same_on_instances(mapper, name, structure):
    expanded = radiance_of(mapper, crowd(NODES[name](), Instancing.EXPANDED, structure), 2)
    assert mapper.device_scene.geometry.instanced is None
    in_levels = radiance_of(mapper, crowd(NODES[name](), Instancing.TWO_LEVELS, structure), 2)
    assert mapper.device_scene.geometry.instanced is not None
    assert expanded[..., :3].std() > 0.05
    np.testing.assert_array_equal(in_levels, expanded)
