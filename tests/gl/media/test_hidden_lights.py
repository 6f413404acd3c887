# SPDX-License-Identifier: GPL-3.0-or-later
"""Lights that are hidden from Volume Scatter: media scatter none of their light, and let it pass as before."""

import dataclasses

import numpy as np
import pytest
import scenes
from support.lobes import Lobe, LobeKind, material

from rppm_addon.scene import (
    Camera,
    Instance,
    Light,
    LightKind,
    LightLinking,
    Material,
    NodeGraph,
    RayVisibility,
    Scene,
    World,
)
from rppm_addon.scene.settings import DirectLight, RenderSettings

HIDDEN = RayVisibility.ALL & ~RayVisibility.VOLUME_SCATTER
MODES = pytest.mark.parametrize("mode", [DirectLight.RAYS, DirectLight.PHOTONS])


def _cloud() -> Material:
    surface, volume = NodeGraph(), NodeGraph()
    surface.surface = surface.add("volume_boundary", "bsdf")
    coefficients = {"scatter_coefficients": (1.0, 1.0, 1.0), "absorption_coefficients": (0.0, 0.0, 0.0)}
    volume.surface = volume.add("volume_coefficients", "volume", **coefficients)
    return Material("cloud", surface, volume)


def _scene(mode: DirectLight, **members: object) -> Scene:
    """A cloud, seen from the side."""
    camera = Camera(scenes.looking((0.0, -4.0, 0.0), (0.0, 0.0, 0.0)), (-0.2, 0.2, -0.2, 0.2), 8, 8)
    settings = RenderSettings(iterations=2, photons=4096, direct_light=mode, volume_bounces=4)
    instance = Instance(0, scenes.placed(0.0, 0.0, 0.0), [0])
    return Scene(camera, [scenes.box("cloud")], [instance], [_cloud()], settings=settings, **members)


def _lamp(visibility: RayVisibility, z: float = 1.5) -> Light:
    return Light("lamp", LightKind.POINT, scenes.placed(0.0, 0.0, z), np.full(3, 10.0), visibility=visibility)


def _shine(renderer, scene: Scene) -> np.ndarray:
    return renderer.render(scene).frame.combined[..., :3]


@MODES
def test_a_hidden_lamp_lights_no_medium(renderer, mode):
    assert _shine(renderer, _scene(mode, lights=[_lamp(RayVisibility.ALL)])).mean() > 0.0
    assert _shine(renderer, _scene(mode, lights=[_lamp(HIDDEN)])).max() == 0.0


@MODES
def test_a_hidden_world_lights_no_medium(renderer, mode):
    """The camera sees it through the cloud as it does without scattered light."""
    shown, hidden = (
        _shine(renderer, _scene(mode, world=World(np.ones(3), visibility=visibility)))
        for visibility in (RayVisibility.ALL, HIDDEN)
    )
    assert shown.mean() > 1.5 * hidden.mean()
    np.testing.assert_allclose(hidden[4, 4], np.exp(-2.0), rtol=0.02)


@MODES
def test_a_hidden_surface_lights_no_medium(renderer, mode):
    def shining(visibility: RayVisibility) -> np.ndarray:
        scene = _scene(mode)
        scene.materials.append(material("glow", Lobe(LobeKind.EMISSION, color=(5.0, 5.0, 5.0))))
        scene.meshes.append(scenes.square("lamp", 0.5))
        scene.instances.append(Instance(1, scenes.placed(0.0, 0.0, 1.5), [1], visibility=visibility))
        return _shine(renderer, scene)

    assert shining(RayVisibility.ALL).mean() > 0.0
    assert shining(HIDDEN).max() == 0.0


def test_light_that_a_surface_has_reflected_is_scattered(renderer):
    """Only the segment from the lamp is hidden, as in Cycles."""
    scene = _scene(DirectLight.RAYS, lights=[_lamp(HIDDEN, -1.4)])
    scene.materials.append(scenes.diffuse(0.8, 0.8, 0.8))
    scene.meshes.append(scenes.square("floor", 1.0))
    scene.instances.append(Instance(1, scenes.placed(0.0, 0.0, -1.5), [1]))
    reflected = _shine(renderer, scene)
    assert reflected.mean() > 0.0
    scene.lights[0] = dataclasses.replace(scene.lights[0], visibility=RayVisibility.ALL)
    assert _shine(renderer, scene).mean() > 1.5 * reflected.mean()


@MODES
def test_a_lamp_that_is_linked_to_some_objects_lights_no_medium(renderer, mode):
    """Media count as objects that no light names, as in Cycles."""
    for membership, lights in ((0b10, False), (0b11, True)):
        linked = dataclasses.replace(_lamp(RayVisibility.ALL), linking=LightLinking(light_set_membership=membership))
        assert (_shine(renderer, _scene(mode, lights=[linked])).max() > 0.0) == lights


@MODES
def test_a_surface_that_is_linked_to_some_objects_lights_no_medium(renderer, mode):
    for membership, lights in ((0b10, False), (0b11, True)):
        scene = _scene(mode)
        scene.materials.append(material("glow", Lobe(LobeKind.EMISSION, color=(5.0, 5.0, 5.0))))
        scene.meshes.append(scenes.square("lamp", 0.5))
        linking = LightLinking(light_set_membership=membership)
        scene.instances.append(Instance(1, scenes.placed(0.0, 0.0, 1.5), [1], linking=linking))
        assert (_shine(renderer, scene).max() > 0.0) == lights


def test_light_linking_of_volumes_is_warned_of(renderer):
    scene = _scene(DirectLight.RAYS, lights=[_lamp(RayVisibility.ALL)])
    renderer.render(scene)
    assert not scene.warnings
    scene = _scene(DirectLight.RAYS, lights=[_lamp(RayVisibility.ALL)])
    scene.instances[0] = dataclasses.replace(scene.instances[0], object_name="fog", linking=LightLinking(1))
    renderer.render(scene)
    assert "Light Linking of volumes (fog)" in scene.warnings[0]
