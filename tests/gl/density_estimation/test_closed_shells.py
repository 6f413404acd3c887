# SPDX-License-Identifier: GPL-3.0-or-later
"""Thin closed shells, which keep their light in, and thin things that are not closed, which lose none by it.

A photon does not count where it lies behind the importon's plane, the importon before the photon's, and what sent the
photon behind the importon's plane too (is_shut_off in shaders/common/surface_tolerance.glsl): within a convex shell all
that sends photons lies behind the planes of its outside.
"""

import math

import numpy as np
import pytest
import scenes
from support.lobes import Lobe, LobeKind, material
from test_boundaries import picture, point_light, scene_of, settings, sheet, sun, view

from rppm_addon.scene import DensityEstimation, DirectLight, Mesh, RenderSettings, Scene

SIDES = 32
SEGMENTS = 12
"""Segments of photon and camera paths."""


def frustum(name: str, bottom: float, top: float, height: float) -> Mesh:
    """A closed one about the z axis on z = 0, of these radii, that faces outwards."""
    turns = 2 * np.pi * np.arange(SIDES) / SIDES
    ring = np.stack([np.cos(turns), np.sin(turns), 0 * turns], -1)
    corners = np.concatenate([bottom * ring, top * ring + (0, 0, height)])
    sides = [(k, (k + 1) % SIDES, SIDES + (k + 1) % SIDES, SIDES + k) for k in range(SIDES)]
    return scenes.polygons(name, corners, [*sides, (*range(SIDES - 1, -1, -1),), (*range(SIDES, 2 * SIDES),)])


def fitting(height: float, **options: object) -> Scene:
    """A lamp in a closed shell of this height, a meter above the floor that the camera sees."""
    values = RenderSettings(iterations=4, photons=4096, filter_width=0.0)
    values = values.with_values(photon_path_length=SEGMENTS, camera_path_length=SEGMENTS, **options)
    camera = view((0, 0, -0.5), (0, 0, -1), 0.8)
    camera.matrix[:3, :3] = np.eye(3)
    meshes = [frustum("shell", 0.105, 0.105, height), sheet("floor", (-1.5, -1.5), (1.5, 1.5), -1.0)]
    return scene_of(camera, meshes, [point_light(0, 0, 0.5 * height, color=(50, 50, 50))], values)


@pytest.mark.parametrize("gathers", [True, False])
@pytest.mark.parametrize("height", [0.01, 0.022, 0.04, 0.08])
def test_a_closed_shell_lets_no_light_out(renderer, height, gathers):
    assert (picture(renderer, fitting(height, use_final_gather=gathers)) == 0).all()


def test_nor_do_photons_that_are_rasterized(renderer):
    scene = fitting(0.022, density_estimation=DensityEstimation.RASTERIZED)
    assert (picture(renderer, scene) == 0).all()


@pytest.mark.parametrize("route", [DensityEstimation.GRID, DensityEstimation.RASTERIZED])
@pytest.mark.parametrize("bottom", [0.105, 0.06])
def test_caustics_stay_in_a_shell(renderer, route, bottom):
    """Its underside, with photons straight from the lamp and by mirrors, within a radius that spans the shell."""
    options = settings(0.1, 4, photons=2048, density_estimation=route)
    camera = view((0, 0, -1), (0, 0, 0), 0.05, 8)
    scene = scene_of(camera, [frustum("shell", bottom, 0.105, 0.022)], [point_light(0, 0, 0.011)], options)
    scene.materials[0] = material("half a mirror", Lobe(LobeKind.DIFFUSE, 0.5), Lobe(LobeKind.GLOSSY, 0.5))
    assert (picture(renderer, scene) == 0).all()
    scene.camera = view((0, 0, 0.02), (0, 0, 0), 0.05, 8)
    assert (picture(renderer, scene) > 0).all()  # what the shell hides


def test_a_thin_white_box_keeps_its_light(renderer):
    """A furnace 22 mm high, whose walls shine by 1 and scatter half: each direction has the radiance 1 / (1 - 0.5)."""
    shining = material("furnace", Lobe(LobeKind.EMISSION), Lobe(LobeKind.DIFFUSE, color=(0.5, 0.5, 0.5)))
    means = []
    for seed in range(4):
        scene = fitting(0.022, seed=seed)
        scene.lights, scene.materials = [], [shining]
        scene.meshes, scene.instances = scene.meshes[:1], scene.instances[:1]
        scene.camera = view((0, 0, 0.02), (0, 0, 0), 0.08)
        means.append(picture(renderer, scene).mean())
    error = np.std(means, ddof=1) / math.sqrt(len(means))
    # The t distribution of few seeds.
    assert abs(np.mean(means) - 2.0) < 6 * error + 0.002


@pytest.mark.parametrize("gap", [0.005, 0.02])
def test_a_card_close_to_the_floor_darkens_neither(renderer, gap):
    """In the sun, card and floor are as bright across the card's edge: each takes the photons of the other beyond."""
    meshes = [sheet("floor", (-1, -1), (1, 1)), sheet("card", (0, -1), (1, 1), gap)]
    camera = view((0, 0, 1), (0, 0, 0), 0.2)
    camera.matrix[:3, :3] = np.eye(3)
    means = []
    for seed in range(8):
        options = settings(0.1, photons=8192, iterations=2, seed=seed)
        means.append(picture(renderer, scene_of(camera, meshes, [sun(0, 0, -1)], options))[..., 0].mean(0) * math.pi)
    profile, error = np.mean(means, 0), np.std(means, axis=0, ddof=1) / math.sqrt(8)
    # Photons a gap off count by the kernel of a longer way: 2 (1 - (x^2 + gap^2) / r^2).
    assert (abs(profile - 1.0) < 5 * error.mean() + (gap / 0.1) ** 2).all()


def test_light_passes_a_leaf(renderer):
    """A translucent sheet in the sun from behind, on whose other side photons count."""
    options = settings(0.1, photons=16384, direct_light=DirectLight.PHOTONS)
    scene = scene_of(view((0, 0, -1), (0, 0, 0), 0.3), [sheet("leaf", (-1, -1), (1, 1))], [sun(0.5, 0, -1)], options)
    scene.materials[0] = material("leaf", Lobe(LobeKind.TRANSLUCENT, color=(0.6, 0.6, 0.6)))
    expected = 0.6 / math.pi * math.cos(math.atan(0.5))
    assert picture(renderer, scene).mean() == pytest.approx(expected, rel=0.01)
