# SPDX-License-Identifier: GPL-3.0-or-later
"""Lamps with a radius that reach into a surface: spheres, which shine within as without, and disks that face points."""

import math

import numpy as np
import pytest
import scenes
from support.lobes import Lobe, LobeKind, material

from rppm_addon.integrator.lights import light_list
from rppm_addon.scene import Camera, DirectLight, Instance, Light, LightKind, RayVisibility, Scene

RADIUS, INTENSITY, ALBEDO = 0.5, 2.0, 0.8
PIXELS = 32
MODES = {DirectLight.RAYS: {"iterations": 24, "photons": 64}, DirectLight.PHOTONS: {"iterations": 8, "photons": 60000}}


def over_floor(mode: DirectLight, half: float, iterations: int = 0, **light: object) -> Scene:
    """A floor that halves a lamp, seen from above: a square of so much to either side."""
    lamp = Light("lamp", LightKind.POINT, np.eye(4), np.full(3, INTENSITY), radius=RADIUS, **light)
    floor = scenes.square("floor", 4.0), scenes.diffuse(ALBEDO, ALBEDO, ALBEDO)
    camera = Camera(scenes.placed(0, 0, 4), (-half / 4, half / 4) * 2, PIXELS, PIXELS)
    settings = MODES[mode] | ({"iterations": iterations} if iterations else {})
    return scenes.scene_of(camera, floor, lights=[lamp], direct_light=mode, photon_path_length=1, **settings)


def from_above(renderer, scene: Scene) -> np.ndarray:
    scene.lights[0].visibility &= ~1  # the camera
    return renderer.render(scene).frame.combined[..., 0]


@pytest.mark.parametrize("mode", MODES)
def test_a_floor_within_a_sphere_sees_half_of_it(renderer, mode):
    """The far side of the sphere is seen in all directions: radiance pi times as irradiance, wherever within."""
    seen = from_above(renderer, over_floor(mode, 0.6 * RADIUS))
    expected = ALBEDO * INTENSITY / (math.pi * RADIUS**2)
    assert seen.mean() == pytest.approx(expected, rel=0.02)
    assert seen[8:24, 8:24].mean() == pytest.approx(expected, rel=0.03)


@pytest.mark.parametrize("kind", ["sphere", "disk"])
def test_photons_bring_what_shadow_rays_find(renderer, kind):
    """Within the lamp and beside it."""
    built = [over_floor(mode, 3.0 * RADIUS, 160, soft_falloff=kind == "disk") for mode in MODES]
    pictures = [from_above(renderer, scene) for scene in built]
    by_rays, by_photons = (picture.reshape(4, 8, 4, 8).mean(axis=(1, 3)) for picture in pictures)
    np.testing.assert_allclose(by_photons, by_rays, rtol=0.08)
    assert by_photons.mean() == pytest.approx(by_rays.mean(), rel=0.02)


@pytest.mark.parametrize("looks_back", [False, True])
def test_photons_end_within_a_sphere_behind_a_transparent_card_too(renderer, looks_back):
    """Light from the far side of a sphere to the near one goes on from there as that of the near side alone."""
    scene = over_floor(DirectLight.PHOTONS, 0.4)
    scene.lights[0].matrix = scenes.placed(0, 0, 1)
    scene.materials.append(material("clear", Lobe(LobeKind.TRANSPARENT)))
    for surface in scene.materials if looks_back else ():
        graph = surface.graph
        weight = graph.add("layer_weight", "facing", blend=0.5)
        graph.surface = graph.add("mix_shader", "shader", fac=weight, shader=graph.surface, shader_001=graph.surface)
    alone = from_above(renderer, scene)
    scene.meshes.append(scenes.square("card", 0.3))
    unseen = RayVisibility.ALL & ~RayVisibility.CAMERA
    scene.instances.append(Instance(1, scenes.placed(0, 0, 1), [1], visibility=unseen))
    assert from_above(renderer, scene).mean() == pytest.approx(alone.mean(), rel=0.02)


@pytest.mark.parametrize("casts_shadow", [True, False])
def test_a_wall_hides_parts_of_the_disk_unless_the_lamp_has_no_shadows(mapper, monkeypatch, casts_shadow):
    emitted = []
    for holds in (True, False):
        if not holds:
            monkeypatch.setattr(light_list, "holds_surfaces", lambda *_: False)
        scene = over_floor(DirectLight.PHOTONS, 1.0, soft_falloff=True, casts_shadow=casts_shadow)
        scene.meshes.append(scenes.rectangle("wall", (0, -4, 0), (0, 4, 0), (0, 4, 4), (0, -4, 4)))
        scene.instances.append(Instance(1, np.eye(4), [0]))
        mapper.build(scene)
        assert mapper.device_scene.lights.are_cut == holds
        mapper.iterate()
        emitted.append(mapper.flux_balance()["emitted"])
    if casts_shadow:
        assert 0.0 < emitted[0] < 0.99 * emitted[1]
    else:
        assert emitted[0] == emitted[1] > 0.0
