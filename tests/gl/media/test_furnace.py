# SPDX-License-Identifier: GPL-3.0-or-later
"""Media that absorb nothing, in an even world: they look like nothing at all, and noise falls as theory says."""

import boxes
import fog
import numpy as np
import pytest
import scenes
from boxes import Box
from support.lobes import Lobe, LobeKind, image_world, material

from rppm_addon.integrator.density_estimation.radii import shrinkage_in
from rppm_addon.scene import Image, World
from rppm_addon.scene.settings import DirectLight

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


PATHS = {"photons": 512, "iterations": 4, "volume_bounces": 20}
"""Settings with which camera paths bring nearly all light of a dense medium."""


def test_an_even_world_is_seen_without_noise(mapper):
    """A path that leaves the medium finds the same light wherever it does: what noise there is comes from the few that
    are scattered more often than the limit."""
    found = pictures_of(mapper, furnace(Box(scattering=4.0, g=0.7), **PATHS))
    print(f"\n{found.mean():.4f} +- {found.std():.4f}")
    assert found.mean() == pytest.approx(1.0, abs=0.03)
    assert found.std() < 0.1


@pytest.mark.parametrize(("scattering", "volume_bounces"), [(1.5, 0), (4.0, 3)])
def test_halves_of_a_world_add_up(mapper, scattering, volume_bounces):
    """Shadow rays to a world with an image leave by the image or by the phase function, and to an even one by the phase
    function alone: the sum over the upper and the lower half is the even one."""
    upper = np.zeros((8, 16, 4), np.float32)
    upper[..., 3] = 1.0
    lower = upper.copy()
    upper[4:, :, :3] = lower[:4, :, :3] = 1.0
    scene = furnace(Box(scattering=scattering, g=0.7), **PATHS | {"iterations": 64, "volume_bounces": volume_bounces})
    even, halves, scene.world = pictures_of(mapper, scene), [], image_world(0)
    for half in upper, lower:
        scene.images = [Image("half", half)]
        halves.append(pictures_of(mapper, scene))
    total = np.sum(halves, axis=0)
    ratio = total.mean(axis=(1, 2, 3)) / even.mean()
    error = np.hypot(ratio.std(ddof=1), (even.mean(axis=(1, 2, 3)) / even.mean()).std(ddof=1)) / np.sqrt(8.0)
    print(f"\n{ratio.mean():.4f} +- {error:.4f}, halves {[float(half.mean()) for half in halves]}")
    assert error < 0.01
    assert abs(ratio.mean() - 1.0) < 0.005 + 4.0 * error


@pytest.mark.parametrize("halves", [(0.8, 0.6, 0.4), (0.99, 0.98)], ids=["deep", "near the surface"])
def test_clear_surfaces_within(mapper, halves):
    """Photons are on both sides of surfaces that the medium does not end at, so that none of the kernel is missed; but
    the kernel is cut where the medium ends, be it before such a surface."""

    def mean(*inner: float) -> tuple[float, float]:
        boxes = [(scenes.box("inner", half), material("inner", CLEAR), np.eye(4)) for half in inner]
        settings = {"use_final_gather": False, "direct_light": DirectLight.PHOTONS, "transparent_max_bounces": 64}
        scene = furnace(Box(scattering=2.0), *boxes, **settings)
        found = pictures_of(mapper, scene).mean(axis=(1, 2, 3))
        return float(np.mean(found)), float(np.std(found, ddof=1) / np.sqrt(len(found)))

    (plain, plain_error), (cut, cut_error) = mean(), mean(*halves)
    noise = np.hypot(plain_error, cut_error)
    print(f"\n{plain:.4f} and with surfaces {cut:.4f}, +- {noise:.4f}")
    assert noise < 0.01
    assert abs(cut - plain) < 0.005 + 3.0 * noise


@pytest.mark.parametrize("dimensions", [1, 3])
def test_the_kernel_shrinks_at_the_best_rate(dimensions):
    """r ~ i^(-1 / (d + 4)), by which the squared bias, ~ r^4, falls as fast as the variance, ~ 1 / (i r^d)."""
    many, more = 1000, 8000
    slope = np.log(shrinkage_in(dimensions, more, 2.0 / 3.0) / shrinkage_in(dimensions, many, 2.0 / 3.0)) / np.log(8.0)
    assert shrinkage_in(dimensions, 1, 2.0 / 3.0) == 1.0
    assert slope == pytest.approx(-1.0 / (dimensions + 4.0), abs=1e-3)


FREE_PATHS = 0.7
"""Radius of the first iteration in dense media, mean free paths (photon_map.py)."""


def radiance_of_iterations(mapper, scene, seeds: int, iterations: int) -> tuple[np.ndarray, float]:
    """(iterations, seeds, H, W) radiance of the red channel that each iteration adds, and the photons in the medium,
    on average."""
    found, photons = [], []
    for seed in range(seeds):
        scene.settings = scene.settings.with_values(seed=seed, iterations=iterations)
        mapper.build(scene)
        sums = [np.zeros(())]
        for number in range(1, iterations + 1):
            mapper.iterate()
            sums.append(number * mapper.film.read_radiance()[..., 0].astype(np.float64))
            photons.append(mapper.stages.medium_photons.photon_count)
        found.append(np.diff(np.stack(np.broadcast_arrays(*sums)), axis=0))
    return np.stack(found, axis=1), float(np.mean(photons))


def kernel_beyond(height: np.ndarray) -> np.ndarray:
    """The part of the kernel beyond a plane at a height, in radii."""
    height = np.minimum(height, 1.0)
    return 0.5 - 15.0 / 16.0 * height * (1.0 - height**2 * (2.0 / 3.0 - 0.2 * height**2))


def variance_of_kernel(box: Box, camera, radius: float, paths: int = 16384) -> float:
    """Mean over the pixels of the variance of their radiance for one photon in the medium; of n it is 1 / n of that.

    Paths are independent, and the photons of a path are not: the variance is as the mean squared sum of the kernel
    over the photons of a path. Alone, photons would have 1 / r^3; those that a path leaves in the same kernel, of
    whom there are some sigma r, add 1 / r^2 and less.
    """
    places, numbers = boxes.collisions(box, paths)
    origin, ways = fog.rays(camera)
    ways, rng, extinction = ways.reshape(-1, 3), np.random.default_rng(3), box.extinction[0]
    squares, means = [], []
    for way, (near, far) in zip(ways, np.transpose(box.interval(origin, ways)), strict=True):
        stopped = -np.expm1(-extinction * (far - near))
        distance = near - np.log1p(-rng.random() * stopped) / extinction
        x2 = ((places - origin - distance * way) ** 2).sum(axis=1) / radius**2
        beyond = sum(kernel_beyond(abs(way[1]) * (end - distance) / radius) for end in (far, 2.0 * distance - near))
        kernel = stopped * (1.0 - x2[x2 < 1.0]) / (1.0 - beyond)
        squares.append((np.bincount(numbers[x2 < 1.0], kernel) ** 2).sum())
        means.append(kernel.sum() / stopped)
    return len(places) * float(np.mean(squares) / np.mean(means) ** 2)


@pytest.mark.long
def test_noise_follows_the_kernel(mapper):
    """In a white furnace whose photons bring all light, all noise is that of the photons in the kernel, as each ray
    gives the same elsewhere. The first iteration is left out: nothing has aimed its photons."""
    box, iterations = Box(scattering=2.0), 18
    settings = {"photons": 2048, "use_final_gather": False, "direct_light": DirectLight.PHOTONS}
    scene = furnace(box, half=0.2, **settings)
    found, photons = radiance_of_iterations(mapper, scene, 16, iterations)
    numbers = range(2, iterations + 1)
    radii = np.array([FREE_PATHS / 2.0 * shrinkage_in(3, number, scene.settings.alpha) for number in numbers])
    ends = [variance_of_kernel(box, scene.camera, radius) / photons for radius in (radii[0], radii[-1])]
    exponent = np.log(ends[1] / ends[0]) / np.log(radii[-1] / radii[0])
    assert -2.8 < exponent < -2.0  # -3 where the photons of a path are far from each other
    expected = ends[0] * (radii / radii[0]) ** exponent

    def over_expected(kept: np.ndarray) -> np.ndarray:
        variance = found[1:, kept].var(axis=1, ddof=1).mean(axis=(1, 2)) / expected
        return np.array([variance.mean(), variance[10:].mean() / variance[:6].mean()])

    seeds = np.arange(found.shape[1])
    parts = np.array([over_expected(seeds != left_out) for left_out in seeds])
    error = np.sqrt((len(seeds) - 1) / len(seeds) * ((parts - parts.mean(axis=0)) ** 2).sum(axis=0))  # jackknife
    level, change = over_expected(seeds >= 0)
    print(f"\nvariance over expected {level:.3f}, late over early {change:.3f}, +- {error.round(3)}; {exponent:.2f}")
    assert error.max() < 0.1
    assert abs(level - 1.0) < 0.1 + 3.0 * error[0]  # photons are spread more evenly than by chance
    assert abs(change - 1.0) < 4.0 * error[1]
    mean = found[1:].mean(axis=0).var(axis=0, ddof=1).mean()
    assert mean == pytest.approx(expected.sum() / len(expected) ** 2, rel=0.25)  # iterations are independent
