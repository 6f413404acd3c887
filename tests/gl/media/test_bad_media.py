# SPDX-License-Identifier: GPL-3.0-or-later
"""Media with input that makes no sense: pictures stay finite."""

import math

import fog
import numpy as np
import pytest
import scenes

from rppm_addon.scene import Material, NodeGraph, Scene, World
from rppm_addon.scene.errors import SceneError


def lit(surface: Material, mesh=None, **camera: float) -> Scene:
    """A box of a material over a floor, under a lamp and an even sky."""
    floor = (scenes.square("floor", 3.0), scenes.diffuse(0.8, 0.8, 0.8), scenes.placed(0.0, 0.0, -1.2, 1.0))
    body = (mesh or scenes.box("box"), surface, np.eye(4))
    lamps = [fog.lamp(0.3, 0.2, 1.5, strength=5.0), fog.lamp(0.3, 0.2, 0.5)]
    seen = fog.camera((0.3, -4.0, 0.5), (0.0, 0.0, 0.0), 0.4)
    world = World(np.full(3, 0.1))
    return fog.scene_of(seen, floor, body, lights=lamps, world=world, iterations=2, volume_bounces=8)


def picture(renderer, scene: Scene) -> np.ndarray:
    found = renderer.render(scene).frame.combined
    assert np.isfinite(found).all()
    assert (found[..., :3] >= 0.0).all()
    return found[..., :3]


def scatter(**inputs: object) -> Material:
    surface, volume = NodeGraph(), NodeGraph()
    surface.surface = surface.add("volume_boundary", "bsdf")
    volume.surface = volume.add("volume_scatter", "volume", **{"color": (1.0, 1.0, 1.0)} | inputs)
    return Material("fog", surface, volume)


@pytest.mark.parametrize(
    "inputs",
    [
        {"density": -1.0},
        {"density": 1e6},
        {"density": 1e30},
        {"density": 1e-30},
        {"density": 1.0, "anisotropy": 1.0},
        {"density": 1.0, "anisotropy": -1.0},
        {"density": 1.0, "color": (-1.0, 2.0, 1e6)},
    ],
    ids=str,
)
@pytest.mark.parametrize("of_world", [False, True], ids=["box", "world"])
def test_inputs(renderer, inputs, of_world):
    scene = lit(scatter(**inputs))
    if of_world:
        scene.world.volume, scene.materials[1] = scene.materials[1].interior, fog.fog(0.0)
    assert picture(renderer, scene).max() < 1e6
    assert len(scene.warnings) <= 1


@pytest.mark.parametrize("inputs", [{"density": math.nan}, {"anisotropy": math.inf}, {"color": (math.nan, 1.0, 1.0)}])
def test_what_is_no_number_is_refused_by_name(renderer, inputs):
    with pytest.raises(SceneError, match=next(iter(inputs))):
        renderer.render(lit(scatter(**inputs)))


def test_nodes_that_overflow(renderer):
    """They give infinite density."""
    surface, volume = scatter(), NodeGraph()
    huge = volume.add("math", "value", options={"operation": "MULTIPLY"}, value=1e30, value_001=1e30)
    volume.surface = volume.add("volume_scatter", "volume", color=(1.0, 1.0, 1.0), density=huge)
    surface.interior = volume
    picture(renderer, lit(surface))


@pytest.mark.parametrize("density", [-1.0, 1e-30])
def test_no_medium(renderer, density):
    """A density below zero, or next to none, changes nothing."""
    with_it, without = (picture(renderer, lit(surface)) for surface in (scatter(density=density), scatter(density=0.0)))
    np.testing.assert_allclose(with_it, without, rtol=1e-5)


def test_an_open_mesh(renderer):
    """There is one warning."""
    scene = lit(fog.fog(1.0), scenes.square("card", 1.0))
    picture(renderer, scene)
    (warning,) = scene.warnings
    assert "volume" in warning


@pytest.mark.parametrize(
    "place", [(0.2, -1.0, 0.3), (0.0, -1.0, 1.0), (-1.0, -1.0, -1.0)], ids=["face", "edge", "corner"]
)
def test_a_camera_on_the_surface(renderer, place):
    scene = lit(fog.fog(0.7))
    scene.camera.matrix[:3, 3] = place
    found = picture(renderer, scene)
    assert found.mean() > 0.0


def test_a_lamp_on_the_surface(renderer):
    scene = lit(fog.fog(0.7))
    scene.lights[0].matrix[:3, 3] = 0.3, 0.2, 1.0
    assert picture(renderer, scene).mean() > 0.0
