# SPDX-License-Identifier: GPL-3.0-or-later
"""Media that absorb nothing, in an even world: they look like nothing at all, and noise falls as theory says."""

import fog
import numpy as np
import pytest
import scenes
from boxes import Box
from support.lobes import Lobe, LobeKind, material

from rppm_addon.integrator.density_estimation.radii import shrinkage_in
from rppm_addon.scene import World

EYE = (0.5, -4.0, 0.7)
CLEAR = Lobe(LobeKind.TRANSPARENT)


def furnace(*media: Box | tuple, half: float = 0.12, **settings):
    """The media and other parts in a world of radiance 1."""
    camera = fog.camera(EYE, (0.0, 0.0, 0.0), half)
    settings = {"photons": 32768, "iterations": 6, "volume_bounces": 1024} | settings
    return fog.scene_of(
        camera, *(part.part() if isinstance(part, Box) else part for part in media), world=World(np.ones(3)), **settings
    )


def lost(mapper, extinction: float) -> float:
    """Radiance that the kernel misses where a ray crosses two surfaces of a medium, beyond which no photons are.

    The kernel 15 (1 - x^2) / 8 pi reaches 5/8 of its radius far on average, so 5/16
    across the surface, and half of that beyond it; the ray is not upright on the surface.
    """
    radius = mapper.stages.medium_photons.radius
    assert 0.0 < radius < 0.2
    return 2.0 * 1.2 * 5.0 / 32.0 * radius * extinction


def pictures_of(mapper, scene) -> np.ndarray:
    """(8, H, W, 3) float64 pictures of a scene, one a seed."""
    pictures = []
    for seed in range(8):
        scene.settings = scene.settings.with_values(seed=seed)
        mapper.build(scene)
        for _ in range(scene.settings.iterations):
            mapper.iterate()
        pictures.append(mapper.film.read_radiance()[..., :3])
    return np.array(pictures, np.float64)


def assert_furnace(mapper, scene, extinction: float, most_error: float = 0.05) -> None:
    found = pictures_of(mapper, scene)
    fog.assert_expected(found, 1.0, most_error, bias=lost(mapper, extinction))


CASES = (-0.9, 0.3), (-0.5, 1.0), (0.0, 1.0), (0.5, 1.0), (0.9, 0.3), (0.0, 2.0), (0.5, 2.0)


@pytest.mark.parametrize(("g", "scattering"), CASES)
def test_a_box(mapper, g, scattering):
    """Beams bring the light in thin fog, and points in dense fog. The sharper the peak of the phase function, the fewer
    photons bring the light."""
    assert_furnace(mapper, furnace(Box(scattering=scattering, g=g)), scattering)


def test_colors(mapper):
    assert_furnace(mapper, furnace(Box(scattering=(0.3, 0.6, 1.0), g=0.3)), 1.0)


@pytest.mark.long
def test_two_that_overlap(mapper):
    media = Box(half=0.9, scattering=(0.6, 0.4, 0.9), g=-0.4), Box((0.3, 0.2, 0.15), 0.8, (0.4, 0.7, 0.2), g=0.6)
    assert_furnace(mapper, furnace(*media), 1.1)


def test_within(mapper):
    """The camera is in the medium."""
    scene = furnace(Box(scattering=2.0))
    scene.camera.matrix[:3, 3] = 0.1, -0.3, 0.2
    assert_furnace(mapper, scene, 2.0)


def test_a_dense_box(mapper):
    """Camera paths are scattered before photons count, so that nearly all of what the kernel misses is behind."""
    scene = furnace(Box(scattering=8.0, g=0.4), photons=8192)
    fog.assert_expected(pictures_of(mapper, scene), 1.0, 0.05, bias=0.02)


def test_clear_surfaces_within(mapper):
    """Photons are on both sides of surfaces that the medium does not end at, so that none of the kernel is missed."""

    def mean(*inner: float) -> tuple[float, float]:
        boxes = [(scenes.box("inner", half), material("inner", CLEAR), np.eye(4)) for half in inner]
        scene = furnace(Box(scattering=2.0), *boxes, use_final_gather=False, transparent_max_bounces=64)
        found = pictures_of(mapper, scene).mean(axis=(1, 2, 3))
        return float(np.mean(found)), float(np.std(found, ddof=1) / np.sqrt(len(found)))

    (plain, plain_error), (cut, cut_error) = mean(), mean(0.8, 0.6, 0.4)
    noise = np.hypot(plain_error, cut_error)
    print(f"\n{plain:.4f} and with surfaces {cut:.4f}, +- {noise:.4f}")
    assert noise < 0.01
    assert abs(cut - plain) < 0.01 + 4.0 * noise


@pytest.mark.parametrize("dimensions", [1, 3])
def test_the_kernel_shrinks_at_the_best_rate(dimensions):
    """r ~ i^(-1 / (d + 4)), by which the squared bias, ~ r^4, falls as fast as the variance, ~ 1 / (i r^d)."""
    many, more = 1000, 8000
    slope = np.log(shrinkage_in(dimensions, more, 2.0 / 3.0) / shrinkage_in(dimensions, many, 2.0 / 3.0)) / np.log(8.0)
    assert shrinkage_in(dimensions, 1, 2.0 / 3.0) == 1.0
    assert slope == pytest.approx(-1.0 / (dimensions + 4.0), abs=1e-3)


def runs(mapper, scene, seeds, stops):
    """(stops, seeds, H, W) running means of the red channel after so many iterations, and the radii there."""
    found, radii = [], []
    for seed in range(seeds):
        scene.settings = scene.settings.with_values(seed=seed, iterations=max(stops))
        mapper.build(scene)
        found.append([])
        for number in range(1, max(stops) + 1):
            mapper.iterate()
            if number in stops:
                found[-1].append(mapper.film.read_radiance()[..., 0].astype(np.float64))
                radii.append(mapper.stages.medium_photons.radius)
    return np.moveaxis(np.array(found), 1, 0), np.array(radii).reshape(seeds, -1).mean(axis=0)


@pytest.mark.long
def test_noise_falls_as_the_kernel_shrinks(mapper):
    """In a white furnace all noise is that of the number of photons in the kernel, as each ray gives the same
    elsewhere. A sample's variance is as 1 / r^3, of which that of the mean follows."""
    scene, stops = furnace(Box(scattering=2.0), half=0.2, photons=2048, use_final_gather=False), [2, 16]
    found, radii = runs(mapper, scene, 12, stops)
    alpha = scene.settings.alpha
    shrinkage = np.array([shrinkage_in(3, number, alpha) for number in range(1, stops[-1] + 1)])
    assert radii[1] / radii[0] == pytest.approx(shrinkage[stops[1] - 1] / shrinkage[stops[0] - 1], rel=0.05)
    few, many = ((shrinkage[:count] ** -3.0).sum() / count**2 for count in stops)

    def ratio(kept: np.ndarray) -> float:
        variance = found[:, kept].var(axis=1, ddof=1).mean(axis=(1, 2))
        return float(np.log(variance[1] / variance[0]))

    seeds = np.arange(found.shape[1])
    parts = np.array([ratio(seeds != left_out) for left_out in seeds])
    error = np.sqrt((len(seeds) - 1) / len(seeds) * ((parts - parts.mean()) ** 2).sum())  # jackknife
    print(f"\nratio of variances {ratio(seeds >= 0):.3f} +- {error:.3f}, expected {np.log(many / few):.3f}")
    assert error < 0.3
    assert abs(ratio(seeds >= 0) - np.log(many / few)) < 4.0 * error
