# SPDX-License-Identifier: GPL-3.0-or-later
"""Bias and variance of the running mean against the theory of Knaus and Zwicker (2011), Eq. 1 and 2.

The kernel 2 (1 - x^2) / pi has second moment 1/6 per axis and squared integral 4 / (3 pi) on the unit disk. So an
iteration of radius r is biased by r^2 / 12 times the Laplacian, and independent photons of flux f make the variance
4 f E / (3 pi r^2) of irradiance E. Over N iterations of Eq. 2 the bias falls as N^-(1 - alpha), the variance as
N^-alpha. All scenes have albedo 1 where the camera looks, straight down on z = 0: radiance is E / pi.

The first iterations guide photons and fit the wide radius to what they find, so predictions take each iteration's
radius and the flux of its photons as they were; Eq. 2 alone is compared with the limits.
"""

import dataclasses

import numpy as np
import pytest
import scenes
from scipy.interpolate import CubicSpline
from scipy.stats import norm as normal
from scipy.stats import t as student
from support.lobes import Lobe, LobeKind, material

from rppm_addon.integrator.common.records.photon_paths import PhotonFlag
from rppm_addon.integrator.density_estimation.radii import shrinkage
from rppm_addon.integrator.progressive import ProgressivePhotonMapper
from rppm_addon.scene import Camera, DirectLight, Light, LightKind, Material, Mesh, RayVisibility, Scene

CHECKPOINTS = (1, 2, 4, 8, 16, 32, 64)
SLOPE = slice(CHECKPOINTS.index(4), None)
SECOND_MOMENT, SQUARE_INTEGRAL = 1 / 6, 4 / (3 * np.pi)


@pytest.fixture(scope="module")
def mapper(context, library):
    with context.moderngl:
        mapper = ProgressivePhotonMapper(context, library)
    yield mapper
    with context.moderngl:
        mapper.release()


def camera_down(height: float, half_width: float, size: int) -> Camera:
    return scenes.camera((0, 0, height), (0, 0, 0), half_width, size, True)


def settings(photons: int, radius: float, alpha: float, segments: int) -> dict[str, object]:
    return {
        "photons": photons, "direct_light": DirectLight.PHOTONS, "photon_path_length": segments, "alpha": alpha,
        "camera_path_length": 1, "radius_minimum": radius, "radius_maximum": radius, "filter_width": 0.0,
    }  # fmt: skip


def white_floor(half_width: float) -> tuple[Mesh, Material]:
    return scenes.square("floor", half_width), scenes.diffuse(1, 1, 1)


def lit_floor(light_radius: float, photons: int, radius: float, alpha: float = 0.7, size: int = 8) -> Scene:
    """A light 1 m above a floor: E = pi (1 + x^2)^-1.5, whatever the light's radius."""
    light = Light("light", LightKind.POINT, scenes.placed(0, 0, 1), np.full(3, np.pi), radius=light_radius)
    light.visibility ^= RayVisibility.CAMERA
    options = settings(photons, radius, alpha, 1)
    return scenes.scene_of(camera_down(3, 0.8, size), white_floor(4.0), lights=[light], **options)


def floor_radiance(distance: np.ndarray) -> np.ndarray:
    return (1 + distance**2) ** -1.5


LENS_HEIGHT, LENS_CURVATURE, LENS_INDEX, LENS_HALF, LENS_CELLS = 1.5, 1.0, 1.5, 0.52, 96


def lens(photons: int, radius: float, alpha: float = 0.7, size: int = 8) -> Scene:
    """Sun of 1 W/m^2 straight down through one refracting paraboloid; the camera is between it and the floor.

    The paraboloid's facets darken the caustic by 5e-5, a four-hundredth of the bias that is looked for.
    """
    corners = LENS_CELLS + 1
    at = np.linspace(-LENS_HALF, LENS_HALF, corners)
    x, y = (axis.ravel() for axis in np.meshgrid(at, at))
    positions = np.stack([x, y, LENS_HEIGHT - 0.5 * LENS_CURVATURE * (x**2 + y**2)], 1).astype(np.float32)
    normals = np.stack([LENS_CURVATURE * x, LENS_CURVATURE * y, np.ones_like(x)], 1)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    corner = (np.arange(LENS_CELLS)[:, None] * corners + np.arange(LENS_CELLS)).reshape(-1, 1)
    triangles = (corner + [[0, 1, corners + 1, 0, corners + 1, corners]]).reshape(-1, 3).astype(np.int32)
    vertices, slots = np.arange(len(positions), dtype=np.int32), np.zeros(len(triangles), np.int32)
    sheet = Mesh("lens", positions, vertices, normals.astype(np.float32), triangles, slots)
    glass = material("glass", Lobe(LobeKind.REFRACTION, ior=LENS_INDEX))
    sun = Light("sun", LightKind.SUN, scenes.placed(0, 0, 4), np.ones(3))
    parts, options = (white_floor(LENS_HALF), (sheet, glass)), settings(photons, radius, alpha, 2)
    return scenes.scene_of(camera_down(0.3, 0.08, size), *parts, lights=[sun], **options)


def lens_landing(entry: np.ndarray) -> np.ndarray:
    """Distance from the axis on the floor of rays that enter at a distance from the axis, by Snell's law."""
    incidence = np.arctan(LENS_CURVATURE * entry)
    deflection = incidence - np.arcsin(np.sin(incidence) / LENS_INDEX)
    return entry - (LENS_HEIGHT - 0.5 * LENS_CURVATURE * entry**2) * np.tan(deflection)


_ENTRIES = np.linspace(-0.9, 0.9, 4001)
_LENS_ENTRY = CubicSpline(lens_landing(_ENTRIES), _ENTRIES)  # the landing grows up to there, with no fold


def lens_radiance(distance: np.ndarray) -> np.ndarray:
    """The caustic is the beam's area on entry over that on landing; within the lens, over its squared index."""
    distance = np.maximum(distance, 1e-4)
    return _LENS_ENTRY(distance) * _LENS_ENTRY(distance, 1) / (distance * np.pi * LENS_INDEX**2)


CEILING, SPOT = 0.5, 0.3


def bounce(photons: int, alpha: float = 0.7) -> Scene:
    """A spot of half angle 45 degrees below a white ceiling shines up: the floor gets what the ceiling scatters.

    The wide radius is a twentieth of the diagonal, 0.28 m, at first, as ``radius_scale`` bounds it no further.
    """
    ceiling = scenes.inside_out(scenes.square("ceiling", 1.0, CEILING)), scenes.diffuse(1, 1, 1)
    light = Light("spot", LightKind.SPOT, scenes.looking((0, 0, SPOT), (0, 0, 1)), np.ones(3), spot_angle=np.pi / 2)
    light.visibility ^= RayVisibility.CAMERA
    options = settings(photons, 0.01, alpha, 2) | {"radius_scale": 1000.0}
    return scenes.scene_of(camera_down(0.3, 0.3, 8), white_floor(2.0), ceiling, lights=[light], **options)


def _ceiling_light(distance: np.ndarray) -> np.ndarray:
    """Quadrature over the lit disk of the ceiling: Gauss-Legendre across, even steps around."""
    node, weight = np.polynomial.legendre.leggauss(24)
    high = CEILING - SPOT
    across, weight = 0.5 * high * (node + 1), 0.5 * high * weight
    around = 2 * np.pi * np.arange(48) / 48
    lit = high / (high**2 + across**2) ** 1.5 / np.pi  # the ceiling's radiance
    aside = distance[..., None, None]
    apart2 = aside**2 + across**2 - 2 * aside * across * np.cos(around)[:, None]
    transfer = CEILING**2 / (CEILING**2 + apart2) ** 2
    return (transfer * lit * across * weight).sum((-1, -2)) * (2 * np.pi / 48) / np.pi


_DISTANCES = np.linspace(0, 1, 501)
bounce_radiance = CubicSpline(_DISTANCES, _ceiling_light(_DISTANCES), bc_type="clamped")


def pixel_points(scene: Scene) -> np.ndarray:
    """(size, size, 2) points on the floor of the pixels' centers."""
    half, size = scene.camera.window[1], scene.camera.width
    at = half * ((np.arange(size) + 0.5) / size * 2 - 1)
    return np.stack(np.meshgrid(at, at), -1)


def blurred(radiance, points: np.ndarray, radius: float) -> np.ndarray:
    """Return the mean estimate of an iteration of a radius: the radiance under the kernel, by quadrature."""
    node, weight = np.polynomial.legendre.leggauss(12)
    x, weight = 0.5 * (node + 1), 0.5 * weight
    around = 2 * np.pi * (np.arange(16) + 0.5) / 16
    offsets = radius * x[:, None, None] * np.stack([np.cos(around), np.sin(around)], -1)
    distance = np.linalg.norm(points[..., None, None, :] + offsets, axis=-1)
    return (radiance(distance).mean(-1) * (4 * x * (1 - x**2) * weight)).sum(-1)


def running_means(mapper, scene: Scene, seeds: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(seeds, checkpoints, size, size) radiance; (iterations,) means over seeds of the squares of the flux of all
    photons that land in the view, per area, W^2/m^2; (iterations,) means of their radii, m."""
    means, squares, radii = [], [], []
    half, size = scene.camera.window[1], scene.camera.width
    for seed in range(seeds):
        mapper.update(dataclasses.replace(scene, settings=scene.settings.with_values(seed=seed)))
        for iteration in range(1, CHECKPOINTS[-1] + 1):
            mapper.iterate()
            if iteration in CHECKPOINTS:
                means.append(mapper.film.read_radiance()[..., 0])
            photons = mapper.read_photons()[-1]
            near = (abs(photons["position"]) < [half, half, 1e-3]).all(1) & ((photons["flags"] & PhotonFlag.STORED) > 0)
            squares.append((photons["flux"][near, 0].astype(np.float64) ** 2).sum() / (2 * half) ** 2)
            # Interreflection's photons have the wide radius, the others that of the importons.
            diffused = (photons["flags"][near] & PhotonFlag.AFTER_ROUGH_BOUNCE).any()
            radii.append(mapper.splat_radii[1 if diffused else 0])
    means = np.array(means, np.float64).reshape(seeds, len(CHECKPOINTS), size, size)
    return means, np.reshape(squares, (seeds, -1)).mean(0), np.reshape(radii, (seeds, -1)).mean(0)


def predicted_bias(radiance, points: np.ndarray, radii: np.ndarray) -> np.ndarray:
    """(checkpoints, size, size): mean of the iterations' blurred radiance minus the radiance."""
    every = np.array([blurred(radiance, points, radius) for radius in radii])
    exact = radiance(np.linalg.norm(points, axis=-1))
    return np.array([every[:n].mean(0) for n in CHECKPOINTS]) - exact


def laplacian(radiance, points: np.ndarray) -> np.ndarray:
    """By fourth-order differences of the closed form."""
    step, total = 0.004, 0.0
    for axis in np.eye(2):
        for k, weight in zip((-2, -1, 0, 1, 2), (-1, 16, -30, 16, -1), strict=True):
            total = total + weight * radiance(np.linalg.norm(points + k * step * axis, axis=-1))
    return total / (12 * step**2)


def predicted_variance(scene: Scene, radiance, squares: np.ndarray, radii: np.ndarray) -> np.ndarray:
    """(checkpoints,) variance of the running mean of radiance if photons were independent, mean over pixels: an
    iteration's is the mean square of what its photons add, less the square of their mean."""
    mean_square = (radiance(np.linalg.norm(pixel_points(scene), axis=-1)) ** 2).mean()
    each = squares / np.pi**2 * SQUARE_INTEGRAL / radii**2 - mean_square / scene.settings.photons
    return np.array([each[:n].sum() / n**2 for n in CHECKPOINTS])


def slope(values: np.ndarray) -> float:
    """Exponent of N of values (checkpoints,) from N = 4 on."""
    return float(np.polyfit(np.log(CHECKPOINTS[SLOPE]), np.log(values[SLOPE]), 1)[0])


def surely(seeds: int) -> float:
    """Standard errors, themselves estimated from so few seeds, that are as rarely exceeded as 4 known ones are."""
    return float(student.isf(normal.sf(4), seeds - 1))


def resampled(runs: np.ndarray) -> list[np.ndarray]:
    """Bootstrap: 200 times as many of the runs (seeds, ...), drawn with replacement."""
    rng = np.random.default_rng(1)
    return [runs[rng.integers(0, len(runs), len(runs))] for _ in range(200)]


def assert_slope(measured: float, deviation: float, expected: float, limit: float) -> None:
    assert deviation < 0.1  # enough photons to tell
    assert abs(measured - expected) < 4 * deviation


def variance(means: np.ndarray) -> np.ndarray:
    """(checkpoints,) over seeds, the pixels' mean."""
    return means.var(axis=0, ddof=1).mean((1, 2))


def assert_bias(means: np.ndarray, exact: np.ndarray, bias: np.ndarray, alpha: float) -> None:
    """The bias measured, as a multiple of the predicted one, is 1 within the noise of the seeds' mean."""
    share = ((means - exact) * bias).sum((2, 3)) / (bias**2).sum((1, 2))
    mean, error = share.mean(0), share.std(0, ddof=1) / np.sqrt(len(share))
    size = np.sqrt((bias**2).mean((1, 2))) / exact.mean()
    assert error[-1] < 0.05  # enough photons to tell
    assert (abs(mean - 1) < surely(len(share)) * error).all()
    slopes = np.std([slope(size * some.mean(0)) for some in resampled(share)])
    assert_slope(slope(size * mean), slopes, slope(size), alpha - 1)


def assert_variance(means: np.ndarray, expected: np.ndarray, alpha: float) -> None:
    """The variance is that of independent photons at each N, and its slope is theirs, within 4 bootstrap deviations."""
    others = [variance(some) for some in resampled(means)]
    measured, deviation = variance(means), np.std(others, axis=0)
    assert (abs(measured - expected) < 4 * deviation).all()
    assert_slope(slope(measured), np.std([slope(other) for other in others]), slope(expected), -alpha)


@pytest.mark.parametrize("alpha", [0.7, 0.5])
def test_radii_shrink_at_the_rates_of_the_theory(alpha):
    """N^-(1 - alpha) and N^-alpha are limits: the first hundred iterations fall at rates some hundredths off."""
    k = np.arange(1, 1 << 20)
    radii2 = np.concatenate([[1.0], np.cumprod((k + alpha) / (k + 1))])
    assert abs(radii2[CHECKPOINTS[-1] - 1] / shrinkage(CHECKPOINTS[-1], alpha) ** 2 - 1) < 1e-9
    count = np.arange(1, len(radii2) + 1)
    bias, noise = np.cumsum(radii2) / count, np.cumsum(1 / radii2) / count**2
    for values, limit in ((bias, alpha - 1), (noise, -alpha)):
        assert abs(np.log(values[(1 << 20) - 1] / values[(1 << 19) - 1]) / np.log(2) - limit) < 1e-3


ALPHAS = [0.7, pytest.param(0.5, marks=pytest.mark.long)]


@pytest.mark.parametrize("alpha", ALPHAS)
def test_bias_of_direct_light(mapper, alpha):
    scene = lit_floor(0.0, 8192, 0.3, alpha)
    points = pixel_points(scene)
    means, _, radii = running_means(mapper, scene, 8)
    bias = predicted_bias(floor_radiance, points, radii)
    leading = 0.5 * SECOND_MOMENT * laplacian(floor_radiance, points) * radii[0] ** 2
    ratio = (bias[0] * leading).sum() / (leading**2).sum()
    assert abs(ratio - 1) < radii[0] ** 2  # the next order
    assert_bias(means, floor_radiance(np.linalg.norm(points, axis=-1)), bias, alpha)


@pytest.mark.long
def test_bias_of_a_caustic(mapper):
    scene = lens(4096, 0.16)
    points = pixel_points(scene)
    means, _, radii = running_means(mapper, scene, 6)
    bias = predicted_bias(lens_radiance, points, radii)
    assert_bias(means, lens_radiance(np.linalg.norm(points, axis=-1)), bias, 0.7)


@pytest.mark.long
def test_bias_of_interreflection(mapper, monkeypatch):
    """With a wide radius that holds a thousand photons: with eight, noise would hide the bias."""
    monkeypatch.setattr("rppm_addon.integrator.density_estimation.radii.EXPECTED_PHOTONS", 1000)
    scene = bounce(4096)
    points = pixel_points(scene)
    means, _, radii = running_means(mapper, scene, 8)
    bias = predicted_bias(bounce_radiance, points, radii)
    assert_bias(means, bounce_radiance(np.linalg.norm(points, axis=-1)), bias, 0.7)


# Few photons in a kernel, so that the strata of the emission's Sobol points, larger than that, do not matter: with
# many the variance is up to hundreds of times smaller than that of independent photons, and falls more slowly.
@pytest.mark.long
@pytest.mark.parametrize("alpha", ALPHAS)
def test_variance_of_direct_light(mapper, alpha):
    scene = lit_floor(0.5, 512, 0.06, alpha, 16)
    means, squares, radii = running_means(mapper, scene, 24)
    assert_variance(means, predicted_variance(scene, floor_radiance, squares, radii), alpha)


@pytest.mark.long
def test_variance_of_a_caustic(mapper):
    scene = lens(512, 0.003, size=16)
    means, squares, radii = running_means(mapper, scene, 24)
    assert_variance(means, predicted_variance(scene, lens_radiance, squares, radii), 0.7)


@pytest.mark.long
def test_total_error_of_interreflection(mapper, monkeypatch):
    """Both: the squared error is the predicted bias' square and the predicted variance, none of them small."""
    monkeypatch.setattr("rppm_addon.integrator.density_estimation.radii.EXPECTED_PHOTONS", 100)
    scene = bounce(2048)
    points = pixel_points(scene)
    means, squares, radii = running_means(mapper, scene, 16)
    noise = predicted_variance(scene, bounce_radiance, squares, radii)
    assert_variance(means, noise, 0.7)
    bias2 = (predicted_bias(bounce_radiance, points, radii) ** 2).mean((1, 2))
    squared = ((means - bounce_radiance(np.linalg.norm(points, axis=-1))) ** 2).mean((2, 3))
    measured, error = squared.mean(0), squared.std(0, ddof=1) / np.sqrt(len(squared))
    expected = bias2 + noise
    assert (bias2 > 0.1 * expected).all() and (noise > 0.1 * expected).all()
    assert (abs(measured - expected) < surely(len(squared)) * error).all()
