# SPDX-License-Identifier: GPL-3.0-or-later
"""Density estimation where surfaces end, bend or lie close together: what may not leak, and biases in closed form.

A photon counts where it arrived on the importon's side, with normals at most 45.6 degrees apart and at most 0.35 radii
off the importon's tangent plane (shaders/common/importon.glsl); test_closed_shells.py has the rest.
"""

import dataclasses
import itertools
import math

import numpy as np
import pytest
import scenes
from support.families import some_each_time
from support.lobes import Lobe, LobeKind, material

from rppm_addon.scene import DirectLight, Instance, Light, LightKind, Mesh, RayVisibility, RenderSettings, Scene, World
from rppm_addon.scene.camera import Camera

STEADY = 0.999999  # alpha of a radius that hardly shrinks


def settings(radius: float, segments: int = 1, **others: object) -> RenderSettings:
    values = {"iterations": 4, "photons": 16384, "direct_light": DirectLight.PHOTONS, "alpha": STEADY}
    values |= {"radius_minimum": radius, "radius_maximum": radius, "filter_width": 0.0, "camera_path_length": 1}
    return RenderSettings(**values | {"photon_path_length": segments} | others)


def photons_for(radius: float) -> int:
    """The fewer the wider kernels are, so that each holds hundreds."""
    return 4096 if radius > 0.3 else 16384


def view(position: tuple, target: tuple, half: float, size: int = 32) -> Camera:
    return dataclasses.replace(scenes.camera(position, target, half, size, True), clip_start=1e-5)


def sheet(name: str, low: tuple[float, float], high: tuple[float, float], z: float = 0.0) -> Mesh:
    """A rectangle that faces up."""
    (a, b), (c, d) = low, high
    return scenes.rectangle(name, (a, b, z), (c, b, z), (c, d, z), (a, d, z))


def box(name: str, half: float, inwards: bool = False) -> Mesh:
    return scenes.inside_out(scenes.box(name, half)) if inwards else scenes.box(name, half)


def sun(*toward: float) -> Light:
    """1 W/m^2 from infinitely far."""
    return Light("sun", LightKind.SUN, scenes.looking((0, 0, 0), toward), np.ones(3))


def point_light(*place: float, color: tuple = (1, 1, 1)) -> Light:
    unseen = RayVisibility.ALL ^ RayVisibility.CAMERA
    return Light("light", LightKind.POINT, scenes.placed(*place), np.array(color, float), visibility=unseen)


def scene_of(camera: Camera, meshes: list[Mesh], lights: list[Light], settings: RenderSettings) -> Scene:
    """White diffuse meshes."""
    instances = [Instance(index, np.eye(4), [0]) for index in range(len(meshes))]
    return Scene(camera, meshes, instances, [scenes.diffuse(1, 1, 1)], lights, settings=settings)


def picture(renderer, scene: Scene) -> np.ndarray:
    return renderer.render(scene).frame.combined[..., :3].astype(np.float64)


@pytest.mark.parametrize("direct_light", DirectLight)
@pytest.mark.parametrize("mirrored", [False, True])
def test_a_closed_box_with_walls_of_a_millimeter_is_black_outside(renderer, direct_light, mirrored):
    """With both radii a hundred times the walls' thickness; photons of up to eight diffuse bounces."""
    meshes = [box("inside", 0.5, inwards=True), box("outside", 0.501)]
    options = settings(0.1, 8, photons=4096, direct_light=direct_light, camera_path_length=2)
    camera = view((2, 1.4, 1.1), (0, 0, 0), 1.0)
    scene = scene_of(camera, meshes, [point_light(0.1, -0.1, 0.2)], options)
    scene.materials[0] = scenes.diffuse(0.9, 0.9, 0.9)
    if mirrored:
        scene.camera.matrix = scenes.looking((2, 0, 0), (3, 0, 0))
        surface = material("mirror", Lobe(LobeKind.GLOSSY))
        scenes.add(scene, scenes.rectangle("mirror", (4, -2, -2), (4, -2, 2), (4, 2, 2), (4, 2, -2)), surface)
    assert (picture(renderer, scene) == 0).all()
    scene.camera = view((0.3, 0.3, 0.3), (-1, 0.3, -0.5), 0.1)
    assert (picture(renderer, scene) > 0).mean() > 0.99  # what the walls hide


def test_the_sides_of_a_leaf_are_apart(renderer):
    """A sheet without thickness, red light above it and green light below it."""
    lights = [point_light(0, 0, 1, color=(1, 0, 0)), point_light(0, 0, -1, color=(0, 1, 0))]
    for height, own, other in ((2, 0, 1), (-2, 1, 0)):
        camera = view((0, 0, height), (0, 0, 0), 0.3)
        image = picture(renderer, scene_of(camera, [sheet("leaf", (-1, -1), (1, 1))], lights, settings(0.1)))
        assert (image[..., other] == 0).all()
        assert image[..., own].mean() == pytest.approx(1 / math.pi, rel=0.1)


@pytest.mark.parametrize(("radius", "leaks"), [(0.1, True), (0.0029, True), (0.0028, False)])
def test_sheets_a_millimeter_apart(renderer, radius, leaks):
    """Undersides stay black. The upper sheet's light reaches the lower one's top while 0.35 radii span the gap."""
    meshes = [sheet("upper", (-1, -1), (1, 1), 0.001), sheet("lower", (-1, -1), (1, 1))]

    def seen(z: float, target: float) -> np.ndarray:
        camera = view((0, 0, z), (0, 0, target), 0.3)
        return picture(renderer, scene_of(camera, meshes, [sun(0, 0, -1)], settings(radius, 2)))

    assert (seen(0.0005, 1) == 0).all()  # the upper sheet from below
    assert (seen(-1, 0) == 0).all()  # the lower sheet from below
    between = seen(0.0005, 0).mean() * math.pi
    assert (between > 0.1) if leaks else (between == 0)


def marginal(x: np.ndarray) -> np.ndarray:
    """Share of the kernel 2 (1 - x^2) / pi beyond a line at x radii from its center: integral of
    8 / (3 pi) (1 - u^2)^1.5."""
    u = np.clip(x, -1, 1)
    return 0.5 - (u * (5 - 2 * u**2) * np.sqrt(1 - u**2) + 3 * np.arcsin(u)) / (3 * np.pi)


def test_the_kernel_beyond_a_line():
    u = (np.arange(100000) + 0.5) / 100000
    density = 8 / (3 * np.pi) * (1 - u**2) ** 1.5
    for x in (0.0, 0.3, 0.9):
        assert marginal(np.array(x)) == pytest.approx(density[u > x].sum() / 100000, abs=1e-5)
    assert (density * u).mean() == pytest.approx(8 / (15 * np.pi), abs=1e-5)


@pytest.mark.parametrize("corner", [False, True])
@pytest.mark.parametrize("radius", [0.4, 0.2, 0.1])
def test_a_floor_is_darkened_at_its_rim_and_in_corners(renderer, radius, corner):
    """By the share of the kernel that lies beyond the edge: the sum over the floor is 8 / (15 pi) radii wide. In a
    corner the same, as the wall's photons, here none, do not count on the floor nor the floor's on the wall."""
    meshes = [sheet("floor", (0, -1.5), (1.5, 1.5))]
    if corner:
        meshes.append(scenes.rectangle("wall", (0, -1.5, 0), (0, 1.5, 0), (0, 1.5, 1.2), (0, -1.5, 1.2)))
    options = settings(radius, photons=photons_for(radius))
    camera = view((0.5, 0, 2.5), (0.5, 0, 0), 0.5)
    camera.matrix[:3, :3] = np.eye(3)
    floor = picture(renderer, scene_of(camera, meshes, [sun(0, 0, -1)], options))[..., 0] * math.pi
    distance = (np.arange(32) + 0.5) / 32
    expected = 1 - marginal(distance / radius)
    profile, error = floor.mean(0), floor.std(0, ddof=1) / np.sqrt(32)
    # Splats make the rows of a column alike over a radius: that many fewer are independent.
    alike = np.sqrt(1 + 32 * radius)
    assert (abs(profile - expected) < 4 * error * alike + 1e-3).all()
    if corner:
        wall = view((2.5, 0, 0.5), (0, 0, 0.5), 0.5)
        assert (picture(renderer, scene_of(wall, meshes, [sun(0, 0, -1)], options)) == 0).all()


def test_a_lit_top_leaves_the_sides_of_a_box_black(renderer):
    camera = view((2, 1.4, 0), (0, 0, 0), 0.4)  # level: the top is not seen
    image = picture(renderer, scene_of(camera, [box("box", 0.5)], [sun(0, 0, -1)], settings(0.3)))
    assert (image == 0).all()


@pytest.mark.parametrize("radius", [0.4, 0.2])
@pytest.mark.parametrize("lit", [True, False])
def test_faces_that_meet_at_a_shallow_edge(renderer, radius, lit):
    """Faces less than 45 degrees apart count as one surface, each photon weighed by the importon's own cosine.

    So a slope of 30 degrees in the sun keeps its own brightness up to the edge, but for what is nearer in space than
    on the surface and what is over 0.35 radii off its plane, and a slope that the sun only grazes stays black.
    """
    slope = math.radians(30)
    sine, cosine = math.sin(slope), math.cos(slope)
    ramp = scenes.rectangle("ramp", (0, -1, 0), (cosine, -1, -sine), (cosine, 1, -sine), (0, 1, 0))
    light = sun(0, 0, -1) if lit else sun(cosine, 0, -sine)
    camera = view((0.25 * cosine, 0, 3), (0.25 * cosine, 0, 0), 0.25 * cosine)
    camera.matrix[:3, :3] = np.eye(3)
    meshes = [sheet("floor", (-1, -1), (0, 1)), ramp]
    options = settings(radius, photons=photons_for(radius))
    means = []
    for options.seed in range(4):
        means.append(picture(renderer, scene_of(camera, meshes, [light], options))[..., 0].mean(0) * math.pi / cosine)
    profile, error = np.mean(means, 0), np.std(means, axis=0, ddof=1) / 2
    if not lit:
        assert (profile == 0).all()
        return
    away = (np.arange(32) + 0.5) / 32 * 0.5
    beyond, aside = np.meshgrid((np.arange(400) + 0.5) / 400 * 0.35 * radius / sine, radius * np.linspace(-1, 1, 401))
    chord2 = away[:, None, None] ** 2 + beyond**2 + 2 * away[:, None, None] * beyond * cosine + aside**2
    area = (0.35 * radius / sine / 400) * (2 * radius / 400)
    kernel = 2 * np.maximum(1 - chord2 / radius**2, 0) / (np.pi * radius**2)
    expected = 1 - marginal(away / radius) + kernel.sum((1, 2)) * area
    assert (abs(profile - expected) < 6 * error.mean() + 1e-3).all()


def shared_sky(angle: np.ndarray) -> np.ndarray:
    """Share of an even sky's irradiance that photons at a normal some angles (n,) away bring: nothing from below either
    horizon, and at most 4 times their own cosine."""
    cosine, azimuth = np.meshgrid((np.arange(100) + 0.5) / 100, 2 * np.pi * (np.arange(100) + 0.5) / 100)
    along = np.sqrt(1 - cosine**2) * np.cos(azimuth)
    angle = angle[:, None, None]
    own = cosine * np.cos(angle) + along * np.sin(angle)
    return 2 * np.minimum(cosine, 4 * np.maximum(own, 0)).mean((1, 2))


def ball_estimate(radius: float, even_sky: bool) -> float:
    """Estimate over truth on a lit unit sphere: chords up to d cut areas pi d^2 off a sphere as off a plane, so that
    the kernel keeps its integral but for what the tolerances of plane and normal cut off."""
    reach = min(radius**2, 2 * 0.35 * radius, 2 * (1 - 0.7)) / radius**2
    t = reach * (np.arange(400) + 0.5) / 400  # squared distance over squared radius
    seen = shared_sky(np.arccos(1 - 0.5 * t * radius**2)) if even_sky else 1.0
    return float((2 * (1 - t) * seen).mean() * reach)


@pytest.mark.parametrize(
    ("light", "radius"),
    some_each_time(
        itertools.product(["sun", "world"], [0.2, 0.4, 0.69, 1.0, 1.5]),
        lambda light, radius: (light, radius) in {("sun", 0.2), ("sun", 0.69), ("sun", 1.5), ("world", 0.69)},
    ),
)
def test_a_ball_is_estimated_as_its_closed_form_tells(renderer, light, radius):
    """Sunlight has no bias up to 0.7 of the ball's radius: each photon is weighed by the importon's own cosine.

    Light from all around lacks what the photon's tangent plane hides of the importon's sky: (1 - cos) / 2 for the
    angle between their normals, r^2 / 12 in the mean. Beyond 0.7 the tolerances cut off more and more.
    """
    ball = scenes.sphere("ball", 128, 64)
    options = settings(radius, photons=16384 if radius < 0.5 else 4096)
    scene = scene_of(view((0, 0, 3), (0, 0, 0), 0.15, 16), [ball], [sun(0, 0, -1)], options)
    truth = 1 / math.pi
    if light == "world":
        scene.lights, scene.world, truth = [], World(np.ones(3)), 1.0
    means = []
    for options.seed in range(8):
        image = picture(renderer, scene)[..., 0] / truth
        if light == "sun":
            at = 0.15 * ((np.arange(16) + 0.5) / 8 - 1)
            image /= np.sqrt(1 - at**2 - at[:, None] ** 2)
        means.append(image.mean())
    mean, error = np.mean(means), np.std(means, ddof=1) / math.sqrt(len(means))
    expected = ball_estimate(radius, light == "world")
    assert abs(mean - expected) < 4 * error + 2e-3  # facets of 3 degrees
