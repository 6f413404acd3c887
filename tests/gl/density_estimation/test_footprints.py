# SPDX-License-Identifier: GPL-3.0-or-later
"""Radii of importons against Eq. 3 and 4, and image textures against bilinear interpolation."""

import math

import numpy as np
import pytest
import scenes
from rendering import iterated
from support.lobes import Lobe, LobeKind, material

from rppm_addon.integrator.common.records.importons import IMPORTON
from rppm_addon.scene import Camera, Image, Light, LightKind, Material, Mesh, Scene

SIZE = 24
TANGENT = 0.4  # of half the vertical aperture


SUN = Light("sun", LightKind.SUN, np.eye(4), np.ones(3))
UNBOUND = {"photons": 64, "filter_width": 0.0, "radius_minimum": 1e-9, "radius_maximum": 1e9}


def tilted_view(orthographic: bool, segments: int) -> Scene:
    """A camera that sees a mirror on the left and a floor, and the floor in the mirror."""
    wall = scenes.rectangle("mirror", (-1, -9, 0), (-1, 9, 0), (-1, 9, 9), (-1, -9, 9))
    floor, mirror = scenes.diffuse(0.5, 0.5, 0.5), material("mirror", Lobe(LobeKind.GLOSSY))
    camera = scenes.camera((1, 0.3, 3), (0, 0, 0), 2.0 if orthographic else TANGENT, SIZE, orthographic)
    parts = (scenes.square("floor", 9.0), floor), (wall, mirror)
    return scenes.scene_of(camera, *parts, lights=[SUN], camera_path_length=segments, **UNBOUND)


def rays_beside(camera: Camera, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Origins and directions (..., 3) of rays through points of the window."""
    right, up, forward = camera.matrix[:3, 0], camera.matrix[:3, 1], -camera.matrix[:3, 2]
    aside = x[..., None] * right + y[..., None] * up
    if camera.orthographic:
        return camera.matrix[:3, 3] + aside, np.broadcast_to(forward, aside.shape)
    ray = forward + aside
    return np.broadcast_to(camera.matrix[:3, 3], aside.shape), ray / np.linalg.norm(ray, axis=-1, keepdims=True)


def importons_of(mapper, scene: Scene) -> np.ndarray:
    """IMPORTON records of the first iteration, those of the last segment."""
    return iterated(mapper, scene).stages.importons.importons.read(IMPORTON.dtype, SIZE * SIZE)


@pytest.mark.parametrize("orthographic", [False, True])
def test_radii_are_those_of_equations_3_and_4(mapper, orthographic):
    direct, mirrored = (importons_of(mapper, tilted_view(orthographic, segments)).copy() for segments in (1, 2))
    camera = tilted_view(orthographic, 1).camera
    scale, half, forward = 10.0 * SIZE / 1024, camera.window[1], -camera.matrix[:3, 2]
    side = half * (2 * (np.arange(SIZE) + 0.5) / SIZE - 1)
    origin, ray = (vectors.reshape(-1, 3) for vectors in rays_beside(camera, *np.meshgrid(side, side)))
    to_floor, to_mirror = -origin[:, 2] / ray[:, 2], (-1 - origin[:, 0]) / ray[:, 0]
    front = ray @ forward
    on_floor, on_mirror = direct["radius"] > 0, mirrored["radius"] > 0
    assert on_floor.sum() > 50 and on_mirror.sum() > 50 and not (on_floor & on_mirror).any()

    def equation_3(distance, facing):
        if orthographic:
            return scale * np.sqrt((2 * half / SIZE) ** 2 / (math.pi * facing))
        return scale * np.sqrt(4 * half**2 * distance**2 * front**3 / (math.pi * SIZE**2 * facing))

    np.testing.assert_allclose(direct["radius"][on_floor], equation_3(to_floor, abs(ray[:, 2]))[on_floor], rtol=2e-3)
    # In the mirror: Eq. 3 at the mirror, grown with the whole path's length unless the rays are parallel. The
    # mirrored path to the floor is as long as the straight one to the floor's plane.
    grown = equation_3(to_mirror, abs(ray[:, 0])) * (1.0 if orthographic else to_floor / to_mirror)
    np.testing.assert_allclose(mirrored["radius"][on_mirror], grown[on_mirror], rtol=2e-3)


class Plane:
    """A mirror, or where ``index`` (behind over before) is given a refracting surface, or at the end what is hit."""

    def __init__(self, point: tuple, normal: tuple, index: float = 0.0) -> None:
        self.point, self.index = np.array(point, float), index
        self.normal = np.array(normal, float) / np.linalg.norm(normal)

    def hit(self, origin: np.ndarray, ray: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Distances (...,) and normals (..., 3) where rays (..., 3) meet it."""
        distance = ((self.point - origin) @ self.normal) / (ray @ self.normal)
        return distance, np.broadcast_to(self.normal, ray.shape)

    def rectangle(self, name: str, half: float, flip: bool = False) -> Mesh:
        aside = np.cross(self.normal, [0.3, 0.9, 0.1])
        aside *= half / np.linalg.norm(aside)
        corners = [
            self.point + a * aside + b * np.cross(self.normal, aside) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))
        ]
        return scenes.rectangle(name, *(corners[::-1] if flip else corners))


class Ball:
    """A mirroring sphere."""

    index = 0.0

    def __init__(self, center: tuple, radius: float) -> None:
        self.center, self.radius = np.array(center, float), radius

    def hit(self, origin: np.ndarray, ray: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        offset = origin - self.center
        along = (offset * ray).sum(-1)
        distance = -along - np.sqrt(along**2 - (offset**2).sum(-1) + self.radius**2)
        return distance, (offset + distance[..., None] * ray) / self.radius


def mirroring_ball() -> tuple[Ball, Mesh]:
    mesh = scenes.sphere("ball", 512, 256)
    mesh.positions = (mesh.positions * 0.5 + np.array([3, 0, 2])).astype(np.float32)
    return Ball((3, 0, 2), 0.5), mesh


def trace(origin: np.ndarray, ray: np.ndarray, surfaces: list) -> tuple[np.ndarray, list, list]:
    """Rays along a chain in float64: landing points, and each surface's segment length and cosine, (...,)."""
    lengths, cosines = [], []
    for surface in surfaces:
        distance, normal = surface.hit(origin, ray)
        origin = origin + distance[..., None] * ray
        cosine = (ray * normal).sum(-1)
        lengths.append(distance)
        cosines.append(abs(cosine))
        if surface.index:
            facing = -np.sign(cosine)[..., None] * normal
            inside = np.sqrt(1 - (1 - cosine**2) / surface.index**2)
            ray = ray / surface.index + (abs(cosine) / surface.index - inside)[..., None] * facing
        else:
            ray = ray - 2 * cosine[..., None] * normal
    return origin, lengths, cosines


def chain_materials(surfaces: list) -> list[Material]:
    """Mirrors, refracting surfaces, and a diffuse one at the end."""
    mirror, glass = material("mirror", Lobe(LobeKind.GLOSSY)), material("glass", Lobe(LobeKind.REFRACTION, ior=1.5))
    return [*(glass if surface.index else mirror for surface in surfaces[:-1]), scenes.diffuse(0.5, 0.5, 0.5)]


def chain_footprints(mapper, surfaces: list, meshes: list, position: tuple, target: tuple, orthographic: bool):
    """Return values of the pixels whose path follows the chain: the landing parallelogram's area by ray differentials
    and the area pi (r / s_r)^2 that the renderer's radius stands for, m^2, and each surface's segment lengths and
    cosines."""
    half = 0.3 if orthographic else 0.05
    camera = scenes.camera(position, target, half, SIZE, orthographic)
    parts = zip(meshes, chain_materials(surfaces), strict=True)
    scene = scenes.scene_of(camera, *parts, lights=[SUN], camera_path_length=len(surfaces), **UNBOUND)
    importons = importons_of(mapper, scene)
    step = 2 * half / SIZE
    x, y = np.meshgrid(*2 * [step * (np.arange(SIZE) + 0.5) - half])
    # The pixel's center, and points a tenth of a pixel beside it.
    x = x.ravel() + step * np.array([0, 0.1, -0.1, 0, 0])[:, None]
    y = y.ravel() + step * np.array([0, 0, 0, 0.1, -0.1])[:, None]
    with np.errstate(invalid="ignore"):  # rays beside the ball
        landed, lengths, cosines = trace(*rays_beside(camera, x, y), surfaces)
    area = np.linalg.norm(np.cross(landed[1] - landed[2], landed[3] - landed[4]), axis=-1) / 0.2**2
    there = (importons["radius"] > 0) & (np.linalg.norm(importons["position"] - landed[0], axis=-1) < 0.01)
    assert there.sum() > 50
    estimated = np.pi * (importons["radius"] / (10.0 * SIZE / 1024)) ** 2
    return area[there], estimated[there], [a[0, there] for a in lengths], [a[0, there] for a in cosines]


GROUND = Plane((0, 0, 0), (0, 0, 1))


@pytest.mark.parametrize("orthographic", [False, True])
def test_planar_mirrors_leave_only_the_cosine_of_the_last_surface(mapper, orthographic):
    """Eq. 4 keeps the slant of the first surface, and takes it for that of the last."""
    first = Plane((3, 0, 2), (-1, 0.4, 0.3))
    away = np.array([-0.6, 0.64, 0.48])  # where the first mirror sends the view's middle
    down = np.array([0.2, 0.3, -0.93])
    second = Plane(first.point + 1.5 * away, down / np.linalg.norm(down) - away)
    surfaces = [first, second, GROUND]
    meshes = [first.rectangle("first", 0.8), second.rectangle("second", 1.2), GROUND.rectangle("ground", 9)]
    area, estimated, _, cosines = chain_footprints(mapper, surfaces, meshes, (0, 0, 2), (3, 0, 2), orthographic)
    np.testing.assert_allclose(estimated * cosines[0] / cosines[-1], area, rtol=2e-3)


def test_a_glass_slab_shortens_the_path(mapper):
    """In glass rays spread more slowly: straight through, a slab of thickness t counts as t / index. Eq. 4 counts t."""
    entry, exit = Plane((0, 0, 2.5), (0, 0, 1), 1.5), Plane((0, 0, 0.5), (0, 0, 1), 1 / 1.5)
    meshes = [entry.rectangle("entry", 9), exit.rectangle("exit", 9, flip=True), GROUND.rectangle("ground", 9)]
    area, estimated, lengths, _ = chain_footprints(
        mapper, [entry, exit, GROUND], meshes, (0, 0, 4), (0.01, 0, 0), False
    )
    before, within, after = lengths
    neglected = ((before + within / 1.5 + after) / (before + within + after)) ** 2
    np.testing.assert_allclose(area / estimated, neglected, rtol=5e-3)
    assert neglected.max() < 0.72  # what Eq. 4 neglects here


def test_a_curved_mirror_spreads_more_than_equation_4_tells(mapper):
    """Coddington's equations: a sphere of radius R adds 2 l0 l1 / R to the spread of l0 + l1, divided by the cosine
    in the plane of incidence, times the cosine across it."""
    ball, mesh = mirroring_ball()
    meshes = [mesh, GROUND.rectangle("ground", 9)]
    area, estimated, lengths, cosines = chain_footprints(mapper, [ball, GROUND], meshes, (0, 0, 2), (3, 0, 1.68), False)
    (l0, l1), (first, last) = lengths, cosines
    bent = 2 * l0 * l1 / 0.5
    spread = (l0 + l1 + bent / first) * (l0 + l1 + bent * first) / (l0 + l1) ** 2
    ratio = area / (estimated * first / last)
    # Facets slant up to 0.4 degrees off the sphere, and Eq. 3 takes their cosine.
    np.testing.assert_allclose(ratio, spread, rtol=0.03)
    assert ratio.min() > 10


def texture(kind: str) -> tuple[Image, np.ndarray]:
    """An image and its (height, width, 3) pixels as they are encoded."""
    rng = np.random.default_rng(5)
    if kind == "half":
        pixels = rng.uniform(0, 8, (5, 7, 4)).astype(np.float32)
        return Image("half", pixels), pixels[..., :3].astype(np.float16).astype(float)
    pixels = rng.integers(0, 256, (5, 7, 4), np.uint8)
    return Image(kind, pixels, "SRGB" if kind == "sRGB" else "LINEAR"), pixels[..., :3] / 255


@pytest.mark.parametrize("kind", ["sRGB", "bytes", "half"])
def test_image_textures_are_bilinear_and_repeat(renderer, kind):
    """As Cycles does (tests/parity/features): filtered first, decoded then."""
    image, encoded = texture(kind)
    sheet = scenes.square("sheet", 1.0)
    sheet.corner_uv = np.array([(-0.5, -0.25), (1.5, -0.25), (1.5, 1.75), (-0.5, 1.75)], np.float32)
    camera = scenes.camera((0, 0, 1), (0, 0, 0), 1.0, 40, True)
    camera.matrix[:3, :3] = np.eye(3)
    glow = material("glow", Lobe(LobeKind.EMISSION, color=(1, 2, 3), color_image=0))
    scene = scenes.scene_of(camera, (sheet, glow), iterations=1, photons=64, filter_width=0.0)
    scene.images = [image]
    got = renderer.render(scene).frame.combined[..., :3]
    at = (np.arange(40) + 0.5) / 40 * 2
    u, v = (at - 0.5) * 7 - 0.5, (at - 0.25) * 5 - 0.5
    column, row = np.floor(u).astype(int), np.floor(v).astype(int)
    fu, fv = (u - column)[None, :, None], (v - row)[:, None, None]

    def texel(dy, dx):
        return encoded[(row + dy) % 5][:, (column + dx) % 7]

    expected = (1 - fv) * ((1 - fu) * texel(0, 0) + fu * texel(0, 1)) + fv * ((1 - fu) * texel(1, 0) + fu * texel(1, 1))
    if kind == "sRGB":
        expected = np.where(expected <= 0.04045, expected / 12.92, ((expected + 0.055) / 1.055) ** 2.4)
    np.testing.assert_allclose(got, expected * [1, 2, 3], rtol=2e-3, atol=2e-3)
