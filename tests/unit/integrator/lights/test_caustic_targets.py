# SPDX-License-Identifier: GPL-3.0-or-later
"""Which objects photons are aimed at, as those that make caustics."""

from types import SimpleNamespace

import numpy as np
import pytest

from rppm_addon.integrator.lights.caustic_casters import caustic_targets
from rppm_addon.scene import Camera, Material, NodeGraph, Scene


def targets(thin_wall: bool, **inputs: float) -> np.ndarray:
    """Return the caustic targets of one object with a Principled surface in a much larger scene."""
    graph = NodeGraph()
    graph.surface = graph.add("bsdf_principled", "bsdf", options={"thin_wall": thin_wall}, roughness=0.0, **inputs)
    return targets_of(graph)


def targets_of(graph: NodeGraph) -> np.ndarray:
    """The same with a surface of these nodes."""
    placement = SimpleNamespace(instance=SimpleNamespace(materials=[0]))
    geometry = SimpleNamespace(placements=[placement], boxes=np.array([[np.zeros(3), np.ones(3)]]), radius=10.0)
    camera = Camera(np.eye(4), (-1.0, 1.0, -1.0, 1.0), 64, 64)
    return caustic_targets(Scene(camera, materials=[Material("Surface", graph)]), geometry)


@pytest.mark.parametrize(
    ("thin_wall", "inputs", "found"),
    [
        (False, {"transmission_weight": 1.0}, 1),
        (True, {"transmission_weight": 1.0}, 0),
        (True, {"transmission_weight": 1.0, "metallic": 0.5}, 1),
        (False, {}, 0),
    ],
    ids=["glass", "thin glass, which bends no light", "thin metal", "dielectric"],
)
def test_principled_surfaces_that_make_caustics(thin_wall, inputs, found):
    spheres = targets(thin_wall, **inputs)
    assert len(spheres) == found
    if found:
        np.testing.assert_allclose(spheres[0], [0.5, 0.5, 0.5, np.sqrt(0.75)])


@pytest.mark.parametrize(("factor", "found"), [((0.0, 0.0, 0.02), 0), ((0.0, 1.0, 0.0), 1), (0.02, 0), (0.7, 1)])
def test_a_color_in_place_of_a_factor_counts_by_its_luminance(factor, found):
    graph = NodeGraph()
    diffuse, glass = graph.add("bsdf_diffuse", "bsdf"), graph.add("bsdf_glass", "bsdf")
    graph.surface = graph.add("mix_shader", "shader", fac=factor, shader=diffuse, shader_001=glass)
    assert len(targets_of(graph)) == found
