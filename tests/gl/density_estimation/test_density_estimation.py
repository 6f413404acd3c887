# SPDX-License-Identifier: GPL-3.0-or-later
"""Both routes of density estimation, rasterized splatting and photon grids, give the same bits."""

import dataclasses
from weakref import WeakKeyDictionary

import numpy as np
import pytest
import scenes
from busy_scenes import HEIGHT, SCENES, WIDTH, busy, wide
from rendering import iterated, radiance_of
from support.floor import floor_scene
from support.lobes import Lobe, LobeKind, material

from rppm_addon.integrator.common import band
from rppm_addon.integrator.common.records.photon_paths import PhotonFlag
from rppm_addon.integrator.common.records.photons import PHOTON_CONTRIBUTED
from rppm_addon.integrator.density_estimation import density_estimator
from rppm_addon.integrator.density_estimation.density_estimator import DensityEstimator
from rppm_addon.scene import DensityEstimation, Scene

ITERATIONS = 3


def rendered(mapper, scene: Scene, route: DensityEstimation) -> list[np.ndarray]:
    """The film, the radii, the sums with signs of the last pixels in each iteration, how many photons they took, and
    which of its photons contributed."""
    scene = dataclasses.replace(scene, settings=dataclasses.replace(scene.settings, density_estimation=route))
    mapper.build(scene)
    found = []
    for _ in range(ITERATIONS):
        mapper.iterate()
        photons = mapper.read_photons()
        sums, count = mapper.stages.density_estimator.sums, mapper.stages.bands[-1].pixel_count
        found += [sums.signed(count), sums.photons_taken(count)]
        found += [(photons["depth"] & PHOTON_CONTRIBUTED != 0) & (photons["flags"] & PhotonFlag.STORED != 0)]
    state = mapper.state()
    return [state.radiance, np.array([state.wide_radius]), state.radius_factors, *found]


def assert_same_bits(first: list[np.ndarray], second: list[np.ndarray]) -> None:
    for a, b in zip(first, second, strict=True):
        np.testing.assert_array_equal(a.view(np.uint8), b.view(np.uint8))


@pytest.mark.parametrize(
    ("name", "rows"), [*((name, HEIGHT) for name in SCENES), ("busy", 7), ("roulette", 7), ("panorama", 7)]
)
def test_both_routes_give_the_same_bits(mapper, monkeypatch, name, rows):
    """Also in bands of a few rows."""
    monkeypatch.setattr(band, "MAXIMUM_BAND_PIXELS", WIDTH * rows)
    rasterized = rendered(mapper, SCENES[name](), DensityEstimation.RASTERIZED)
    gathered = rendered(mapper, SCENES[name](), DensityEstimation.GRID)
    assert_same_bits(rasterized, gathered)
    if name != "dark":
        assert rasterized[5].sum() > 50, "next to no photon was taken: the test shows nothing"


@pytest.mark.parametrize("rasterized_takes", [0.5, 2.0])
def test_the_faster_route_is_taken_and_kept(mapper, other_mapper, monkeypatch, rasterized_takes):
    monkeypatch.setattr(density_estimator, "_faster", WeakKeyDictionary())
    monkeypatch.setattr(density_estimator, "_may_rasterize", lambda context: True)
    monkeypatch.setattr(density_estimator, "_FEWEST_TO_TRY", 100)
    expected = rendered(mapper, busy(), DensityEstimation.RASTERIZED)
    tried = []
    seconds = DensityEstimator._seconds

    def pretended(self, name, photons, importons):
        seconds(self, name, photons, importons)
        tried.append((name, photons.count))
        return rasterized_takes if name is DensityEstimation.RASTERIZED else 1.0

    monkeypatch.setattr(DensityEstimator, "_seconds", pretended)
    got = rendered(mapper, busy(), DensityEstimation.AUTOMATIC)
    assert_same_bits(got, expected)  # trying adds nothing
    faster = DensityEstimation.RASTERIZED if rasterized_takes < 1.0 else DensityEstimation.GRID
    assert mapper.density_estimation is faster
    assert {name for name, _ in tried} == {DensityEstimation.RASTERIZED, DensityEstimation.GRID}
    # Rasterization goes on until it is clear.
    photons = [count for name, count in tried if name is DensityEstimation.RASTERIZED]
    assert (photons[-1] == max(count for _, count in tried)) == (faster is DensityEstimation.RASTERIZED)
    assert photons == sorted(photons)
    tried.clear()
    iterated(other_mapper, wide(scenes.room(8, photons=2000)))
    assert not tried and other_mapper.density_estimation is faster
    for each in (mapper, other_mapper):
        assert ("splat jobs" in each.memory_bytes) == (faster is DensityEstimation.RASTERIZED)
        assert ("sorted photons" in each.memory_bytes) == (faster is DensityEstimation.GRID)


def test_software_drivers_gather(mapper):
    if not mapper.context.is_software:
        pytest.skip("the device is no software driver")
    assert iterated(mapper, busy()).density_estimation is DensityEstimation.GRID


@pytest.mark.parametrize("route", [DensityEstimation.RASTERIZED, DensityEstimation.GRID])
def test_light_that_is_taken_away_has_the_bits_of_light(mapper, route):
    """On a floor so dark that sums are few quanta."""
    pictures = []
    for sign in (1.0, -1.0):
        scene = floor_scene()
        scene.materials[0] = material("dark", Lobe(LobeKind.DIFFUSE, color=(1e-4, 1e-5, 1e-6)))
        scene.lights[0].strength = sign * scene.lights[0].strength
        scene.settings = scene.settings.with_values(direct_light="PHOTONS", density_estimation=route)
        pictures.append(radiance_of(mapper, scene)[..., :3])
    assert pictures[0].any()
    np.testing.assert_array_equal(-pictures[1], pictures[0])
