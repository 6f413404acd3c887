# SPDX-License-Identifier: GPL-3.0-or-later
"""Next-event sampling of emitters: spread in solid angle, densities, and a variance that corners leave bounded."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scenes
from support.families import some_each_time
from support.lobes import Lobe, LobeKind, material
from test_light_sources import floor_scene

from rppm_addon.gl.buffers.records import Record
from rppm_addon.integrator.common.iteration import Iteration
from rppm_addon.integrator.lights.light_entry import spread_constants
from rppm_addon.scene import DirectLight, Light, LightKind, Scene

Record("SphericalTriangleParameters", count="uint", samples="uint")
Record("LightSamplesParameters", count="uint", point="vec3", emitted="float")
FOLDER = Path(__file__).parent
SAMPLES, PARTS = 1 << 14, 4


def solid_angles(corners: np.ndarray) -> np.ndarray:
    """(...,) sr of triangles (..., 3, 3) as seen from the origin (Van Oosterom and Strackee 1983)."""
    a, b, c = np.moveaxis(corners / np.linalg.norm(corners, axis=-1, keepdims=True), -2, 0)
    volume = np.abs((a * np.cross(b, c)).sum(-1))
    return 2 * np.arctan2(volume, 1 + (a * b).sum(-1) + (b * c).sum(-1) + (c * a).sum(-1))


def irradiance(polygon: np.ndarray, normal: np.ndarray) -> float:
    """Return the irradiance at the origin from a polygon (n, 3) of radiance 1, W/m^2 (Lambert 1760).

    The polygon is wholly above the plane through the origin that has the normal.
    """
    unit = polygon / np.linalg.norm(polygon, axis=1, keepdims=True)
    following = np.roll(unit, -1, axis=0)
    turned = np.cross(unit, following)
    sine = np.linalg.norm(turned, axis=1)
    angles = np.arctan2(sine, (unit * following).sum(1))
    return abs(0.5 * ((angles / sine) @ turned) @ normal)


def parts_of(corners: np.ndarray) -> np.ndarray:
    """(PARTS^2, 3, 3) equal parts of a triangle (3, 3), row by row as ``part_numbers`` counts them."""
    parts = []
    for i in range(PARTS):
        for j in range(PARTS - i):
            lower, right, upper, far = (
                (corners[0] * (PARTS - x - y) + corners[1] * x + corners[2] * y) / PARTS
                for x, y in ((i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1))
            )
            parts.append((lower, right, upper))
            if i + j < PARTS - 1:
                parts.append((far, right, upper))
    return np.array(parts)


def part_numbers(corners: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Which of ``parts_of`` each of the points (n, 3) of the triangle lies in."""
    coordinates = np.linalg.lstsq((corners[1:] - corners[0]).T, (points - corners[0]).T, rcond=None)[0] * PARTS
    i, j = np.clip(np.floor(coordinates), 0, PARTS - 1).astype(int)
    upper = (coordinates.sum(0) - i - j > 1).astype(int)
    first = np.cumsum([0] + [2 * (PARTS - k) - 1 for k in range(PARTS)])
    return np.minimum(first[i] + 2 * j + upper, first[np.minimum(i + 1, PARTS)] - 1)


def triangles() -> dict[str, np.ndarray]:
    """(4, 3) float32 by name: a point and a triangle's corners."""
    generator = np.random.default_rng(5)
    made = {}
    for k in range(16):
        made[f"any {k}"] = generator.normal(size=(4, 3))
        far = generator.normal(size=(4, 3))
        made[f"small and far {k}"] = np.concatenate(
            [far[:1], far[1] + 10.0 ** -(1 + k / 6) * generator.normal(size=(3, 3))]
        )
        corners = generator.normal(size=(3, 3))
        unit = np.cross(corners[1] - corners[0], corners[2] - corners[0])
        unit /= np.linalg.norm(unit)
        for name, weights in {"inside": (0.3, 0.3, 0.4), "edge": (0.4, 0.6, 0), "corner": (0, 0, 1)}.items():
            place = np.roll(weights, k % 3) @ corners
            made[f"near the {name} {k}"] = np.concatenate([[place + 10.0 ** -(1 + k / 8) * unit], corners])
        made[f"sliver {k}"] = np.concatenate(
            [generator.normal(size=(1, 3)), [corners[0], corners[1], corners[1] + 1e-2 * unit]]
        )
    return {name: value.astype(np.float32) for name, value in made.items()}


def spherical_triangles(context, library, cases: np.ndarray, samples: int) -> tuple[np.ndarray, np.ndarray]:
    """Directions to samples (n, samples, 3) and solid angles (n,) from the GPU, of cases (n, 4, 3)."""
    count = len(cases) * samples
    table = context.moderngl.buffer(np.pad(cases, ((0, 0), (0, 0), (0, 1))).astype(np.float32).tobytes())
    results = context.moderngl.buffer(reserve=16 * count)
    program = library.compute(str(FOLDER / "spherical_triangle.comp"))
    program.run(count, {"Triangles": table, "Results": results}, {"count": count, "samples": samples})
    read = np.frombuffer(results.read(), np.float32).reshape(len(cases), samples, 4).astype(np.float64)
    table.release()
    results.release()
    return read[..., :3], read[:, 0, 3]


def test_triangles_are_sampled_evenly_in_solid_angle(context, library):
    """Counts in sixteen parts of each triangle against their solid angles, chi-square of 15 degrees of freedom."""
    cases = triangles()
    toward, angles = spherical_triangles(context, library, np.array(list(cases.values())), SAMPLES)
    statistics = []
    for (name, case), directions, angle in zip(cases.items(), toward, angles):
        corners = case[1:].astype(np.float64) - case[0]
        expected = solid_angles(corners)
        # Rounding of the products in the volume, whose sum can be far smaller.
        edges = corners[1:] - corners[0]
        normal = np.cross(*edges)
        products = np.linalg.norm(corners[0]) * np.prod(np.linalg.norm(edges, axis=1))
        assert angle == pytest.approx(expected, rel=1e-4 + 4e-7 * products / abs(corners[0] @ normal)), name
        size = np.linalg.norm(corners, axis=1).max()
        height = normal / np.linalg.norm(normal)
        assert np.abs(directions @ height - corners[0] @ height).max() < 2e-6 * size
        shares = solid_angles(parts_of(corners)) / expected
        assert shares.sum() == pytest.approx(1, abs=1e-6)
        counts = np.bincount(part_numbers(corners, directions), minlength=PARTS**2)
        seen = shares * SAMPLES > 5  # where a chi-square holds
        merged = np.append(counts[seen], counts[~seen].sum()), np.append(shares[seen], shares[~seen].sum()) * SAMPLES
        statistic = ((merged[0] - merged[1]) ** 2 / np.maximum(merged[1], 1)).sum()
        statistics.append(statistic)
        assert statistic < 50, f"{name}: {statistic} {counts} {shares * SAMPLES}"


def test_degenerate_triangles_give_no_nan(context, library):
    a, b, c = np.eye(3)
    cases = np.array([
        (a, a, b, c), (b, a, b, c), (c, a, b, c),  # the point is a corner
        ((a + b) / 2, a, b, c), ((a + b + c) / 3, a, b, c), (2 * a - b, a, b, c),  # on an edge, inside, in the plane
        (0 * a, a, a, b), (0 * a, a, a, a), (0 * a, a, b, (a + b) / 2), (0 * a, 0 * a, 0 * a, 0 * a),  # no area
        (0 * a, a, -a, b), (0 * a, 1e-20 * a, 1e-20 * b, 1e-20 * c), (0 * a, 1e12 * a, 1e12 * b, 1e12 * c),
    ])  # fmt: skip
    toward, angles = spherical_triangles(context, library, cases, 1024)
    assert np.isfinite(angles).all() and (angles >= 0).all() and (angles < 6.2832).all(), angles
    assert np.isfinite(toward).all()


AREA = {"size": (0.8, 0.5)}
SHEARED = np.array([[1, 0.7, 0, 0], [0, 1, 0, 0], [0, 0, 1, 1], [0, 0, 0, 1.0]])
EMITTERS = {
    "sphere": Light("sphere", LightKind.POINT, scenes.placed(0, 0, 1), 3 * np.ones(3), radius=0.5),
    "soft": Light("soft", LightKind.POINT, scenes.placed(0, 0, 1), 3 * np.ones(3), radius=0.5, soft_falloff=True),
    "rectangle": Light("rectangle", LightKind.AREA, scenes.placed(0, 0, 1), 5 * np.ones(3), shape="RECTANGLE", **AREA),
    "sheared": Light("sheared", LightKind.AREA, SHEARED, 5 * np.ones(3), shape="RECTANGLE", **AREA),
    "ellipse": Light("ellipse", LightKind.AREA, scenes.placed(0, 0, 1), 5 * np.ones(3), shape="ELLIPSE", **AREA),
    "sheared ellipse": Light("sheared ellipse", LightKind.AREA, SHEARED, 5 * np.ones(3), shape="ELLIPSE", **AREA),
    "spread": Light("spread", LightKind.AREA, scenes.placed(0, 0, 1), 5 * np.ones(3), size=(0.3, 0.3), spread=1.0),
}
POINTS = {"below": (0.1, 0.05, 0.0), "far": (-3.0, 1.0, -7.0), "near": (0.3, -0.2, 0.97), "beside": (0.7, 0.1, 0.96)}


def light_samples(mapper, library, point, count: int = SAMPLES, emitted: float = 0.0) -> dict[str, np.ndarray]:
    """Samples of the scene's first light from a point: direction, distance, weight, pdf, seen, seen_pdf; and what of
    them is received on a plane that faces up."""
    results = mapper.context.moderngl.buffer(reserve=48 * count)
    context = mapper.device_scene.context
    context.begin(Iteration(1, seed=3))
    blocks, values = {**context.blocks, "Results": results}, {"count": count, "point": point, "emitted": emitted}
    library.compute(str(FOLDER / "light_samples.comp")).run(count, blocks, values)
    table = np.frombuffer(results.read(), np.float32).reshape(count, 3, 4).astype(np.float64)
    results.release()
    assert np.isfinite(table).all()
    (direction, weight, seen), (distance, pdf, seen_pdf) = table[..., :3].swapaxes(0, 1), table[..., 3].T
    return {
        "direction": direction, "distance": distance, "weight": weight, "pdf": pdf,
        "seen": seen, "seen_pdf": seen_pdf, "received": weight[:, 0] * direction[:, 2],
    }  # fmt: skip


def assert_mean(received: np.ndarray, expected: float, tolerance: float) -> None:
    """Within 4.5 standard errors and a relative tolerance."""
    assert abs(received.mean() - expected) < 4.5 * received.std() / math.sqrt(SAMPLES) + tolerance * expected


@pytest.mark.parametrize("where", POINTS)
@pytest.mark.parametrize("name", EMITTERS)
def test_what_a_ray_sees_of_a_light_has_the_sampled_pdf(mapper, library, name, where):
    mapper.build(floor_scene(EMITTERS[name], DirectLight.RAYS))
    sample = light_samples(mapper, library, POINTS[where])
    lit = sample["weight"][:, 0] > 0
    if not lit.any():
        # within the sphere, outside the beam
        assert (name, where) in {("sphere", "near"), ("spread", "near"), ("spread", "beside")}
        return
    # On the rim, rounding may take the ray past the light.
    both = lit & (sample["seen"][:, 0] > 0)
    assert both.sum() > 0.999 * lit.sum()
    np.testing.assert_allclose(sample["seen_pdf"][both], sample["pdf"][both], rtol=2e-4)
    np.testing.assert_allclose((sample["seen"][both, 0] / sample["pdf"][both]), sample["weight"][both, 0], rtol=2e-3)


@pytest.mark.parametrize("where", POINTS)
@pytest.mark.parametrize("name", ["rectangle", "sheared"])
def test_area_lights_give_their_irradiance(mapper, library, name, where):
    """On a plane that faces up, against Lambert's closed form."""
    light = EMITTERS[name]
    mapper.build(floor_scene(light, DirectLight.RAYS))
    corners = np.array([(x * 0.4, y * 0.25, 0, 1) for x, y in ((1, 1), (-1, 1), (-1, -1), (1, -1))]) @ light.matrix.T
    expected = 5 * irradiance(corners[:, :3] - POINTS[where], np.array([0, 0, 1.0]))
    assert_mean(light_samples(mapper, library, POINTS[where])["received"], expected, 1e-4)


@pytest.mark.parametrize("where", POINTS)
def test_an_ellipse_gives_the_irradiance_of_its_area(mapper, library, where):
    """Against the light summed over the ellipse by rings, on either side of where the sampling changes."""
    mapper.build(floor_scene(EMITTERS["ellipse"], DirectLight.RAYS))
    rings, spokes = np.meshgrid(np.sqrt((np.arange(800) + 0.5) / 800), 2 * np.pi * (np.arange(800) + 0.5) / 800)
    places = np.stack([0.4 * rings * np.cos(spokes), 0.25 * rings * np.sin(spokes), np.ones_like(rings)], -1)
    offset = places - POINTS[where]
    expected = 5 * np.pi * 0.4 * 0.25 * (offset[..., 2] ** 2 / (offset**2).sum(-1) ** 2).mean()
    assert_mean(light_samples(mapper, library, POINTS[where])["received"], expected, 1e-3)


# Below the middle of the light, its side and its corner, within and beyond them, and farther away than it is wide.
BELOW = {
    "middle": (0.1, 0.05, 0.8), "close": (-0.1, 0.05, 0.999), "side": (0.395, 0.05, 0.8), "corner": (0.39, 0.24, 0.8),
    "half light": (0.41, 0.01, 0.7), "dark": (0.7, -0.3, 0.8), "farther": (0.1, 0.05, -3.0), "far": (0.2, 0.1, -9.0),
    "behind": (0.1, 0.05, 1.2),
}  # fmt: skip
SPREADS = [
    ("rectangle", 10.0), ("sheared", 10.0), ("ellipse", 10.0), ("sheared ellipse", 10.0), ("rectangle", 0.0),
    ("ellipse", 100.0), ("rectangle", 140.0), ("ellipse", 140.0),
]  # fmt: skip


def irradiance_of_spread(light: Light, point) -> tuple[float, float, bool]:
    """By rings around the point's foot on the light at z = 1, W/m^2; the variance if samples were even in the solid
    angle of the parallelogram around the light; whether all of the rings lie on the light."""
    tangent, scale = spread_constants(light.spread)
    height = 1.0 - point[2]
    ring, angle = np.meshgrid((np.arange(1000) + 0.5) / 1000, 2 * np.pi * (np.arange(1000) + 0.5) / 1000)
    offset = height * np.stack([tangent * ring * np.cos(angle), tangent * ring * np.sin(angle), np.ones_like(ring)], -1)
    local = (offset + point - light.matrix[:3, 3]) @ np.linalg.inv(light.matrix[:3, :3]).T / (0.4, 0.25, 1)
    on_light = (
        np.hypot(local[..., 0], local[..., 1]) <= 1 if light.shape == "ELLIPSE" else abs(local[..., :2]).max(-1) <= 1
    )
    distance2 = (offset**2).sum(-1)
    cosine = height / np.sqrt(distance2)
    received = 5 * scale * tangent * (1 - ring) * cosine * on_light
    ring_angles = cosine / distance2 * (height * tangent) ** 2 * ring * 2 * np.pi / ring.size
    corners = np.array([(x * 0.4, y * 0.25, 0) for x, y in ((1, -1), (-1, 1), (-1, -1), (1, 1))])
    corners = corners @ light.matrix[:3, :3].T + light.matrix[:3, 3] - point
    whole = solid_angles(corners[[[0, 1, 2], [0, 1, 3]]]).sum()
    mean = (received * ring_angles).sum()
    return mean, whole * (received**2 * ring_angles).sum() - mean**2, bool(on_light.all())


SPREADS_EACH_TIME = {("rectangle", 0.0), ("rectangle", 140.0), ("ellipse", 10.0), ("sheared ellipse", 10.0)}


@pytest.mark.parametrize(
    ("name", "degrees"), some_each_time(SPREADS, lambda name, degrees: (name, degrees) in SPREADS_EACH_TIME)
)
def test_a_narrow_spread_is_sampled_where_it_shines(mapper, library, name, degrees):
    """Against rings; near the light with half the variance at most of samples of all of the light."""
    light = replace(EMITTERS[name], spread=math.radians(degrees))
    tangent, _ = spread_constants(light.spread)
    mapper.build(floor_scene(light, DirectLight.RAYS))
    for where, point in BELOW.items():
        sample = light_samples(mapper, library, point)
        received = sample["received"]
        if where == "behind":
            assert not received.any()
            continue
        expected, variance_of_whole, all_on_light = irradiance_of_spread(light, point)
        if expected == 0:
            assert not received.any()
            continue
        relative, of_whole = received.var() / expected**2, variance_of_whole / expected**2
        assert_mean(received, expected, 2e-3)
        if degrees <= 10 and point[2] >= 0.7:
            assert relative <= 0.5 * of_whole
        if all_on_light and tangent <= 2:
            # By the falloff itself: what is left is how much farther the rim is.
            assert received.min() > received.max() * (1 + tangent**2) ** -2 * (1 - 1e-3)
        lit = received > 0
        both = lit & (sample["seen"][:, 0] > 0)
        assert both.sum() > 0.999 * lit.sum()
        # Rounding of the direction moves the tangent, and by it what little is left of the falloff at the rim.
        direction = sample["direction"][both]
        left = np.maximum(1 - np.hypot(direction[:, 0], direction[:, 1]) / direction[:, 2] / tangent, 1e-7)
        rounding = 2e-4 + 5e-7 * (tangent + 1 / tangent) / left
        assert (abs(sample["seen_pdf"][both] / sample["pdf"][both] - 1) < rounding).all()
        weight = sample["seen"][both, 0] / sample["seen_pdf"][both]
        assert (abs(weight / sample["weight"][both, 0] - 1) < rounding).all()


def walled_scene() -> Scene:
    """A floor and a wall of side 1 at its edge that emits 1."""
    scene = floor_scene(None, DirectLight.RAYS)
    glow = material("wall", Lobe(LobeKind.EMISSION, color=(1, 1, 1)))
    scenes.add(scene, scenes.rectangle("wall", (0, -0.5, 0), (0, 0.5, 0), (0, 0.5, 1), (0, -0.5, 1)), glow)
    return scene


def test_the_variance_beside_an_emissive_wall_is_bounded(mapper, library):
    """On the floor at a shrinking distance from the wall. Sampled by area the relative variance would grow as the
    distance falls. By solid angle, with two triangles of equal power, no sample exceeds radiance times 2 pi, which
    is four times the mean in the corner: the relative variance stays below 4 - 1."""
    mapper.build(walled_scene())
    corners = np.array([(0, -0.5, 0), (0, 0.5, 0), (0, 0.5, 1), (0, -0.5, 1.0)])
    for distance in (0.5, 0.1, 0.02, 0.004):
        point = np.array([distance, 0.1, 0.0])
        sample = light_samples(mapper, library, point, emitted=1.0)
        np.testing.assert_allclose(sample["seen_pdf"], sample["pdf"], rtol=2e-4)
        received = sample["received"]
        expected = irradiance(corners - point, np.array([0, 0, 1.0]))
        assert_mean(received, expected, 1e-4)
        # Second moment by area, over cells that shrink toward the point's foot.
        edges = np.concatenate([-np.geomspace(0.6, 1e-5, 400), np.geomspace(1e-5, 0.4, 400)])
        heights = np.concatenate([[0], np.geomspace(1e-5, 1, 800)])
        y, z = np.meshgrid((edges[1:] + edges[:-1]) / 2, (heights[1:] + heights[:-1]) / 2)
        cells = np.outer(np.diff(heights), np.diff(edges))
        by_area = ((z * distance / (distance**2 + y**2 + z**2) ** 2) ** 2 * cells).sum() / expected**2 - 1
        by_angle = received.var() / expected**2
        assert received.max() <= 2 * math.pi
        assert by_angle < 3
    assert by_area > 20 * by_angle
