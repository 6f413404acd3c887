# SPDX-License-Identifier: GPL-3.0-or-later
"""Photons that leave media: their flux, and the light that they bring, by closed forms."""

import dataclasses
import gc
import math
import weakref

import fog
import numpy as np
import pytest
import scenes
from support.lobes import Lobe, LobeKind, material

from rppm_addon.scene import Instance, Material, Mesh, NodeGraph, World
from rppm_addon.scene.meshes import RayVisibility

EMISSION = np.array([0.4, 0.7, 1.0])
"""Emission of media, W/(m^3 sr)."""
BALL = scenes.sphere("ball", 64, 32)
CAMERA = fog.camera((0.5, -4.0, 0.5), (0.0, 0.0, 0.0), 0.3)


def volume_of(mesh: Mesh) -> float:
    """The volume of a closed mesh, m^3."""
    a, b, c = np.moveaxis(mesh.positions[mesh.corner_vertices[mesh.triangle_corners]].astype(np.float64), 1, 0)
    return abs(float((a * np.cross(b, c)).sum())) / 6.0


def flux_of(renderer, *parts, **settings) -> dict[str, float]:
    """Flux in W by what became of it, of parts of fog.scene_of."""
    settings = {"photons": 32768, "iterations": 1, "volume_bounces": 64} | settings
    statistics = renderer.render(fog.scene_of(CAMERA, *parts, **settings)).statistics
    flux = statistics.flux_watts
    assert flux["absorbed"] + flux["deposited"] + flux["escaped"] == pytest.approx(flux["emitted"], rel=1e-4)
    assert flux["lost"] == 0.0
    return flux


@pytest.mark.parametrize("scale", [(1.0, 1.0, 1.0), (0.5, -2.0, 0.1)], ids=str)
def test_a_thin_ball_lets_all_of_its_light_escape(renderer, scale):
    glow = fog.fog(0.0, 0.0, emission=EMISSION)
    flux = flux_of(renderer, (BALL, glow, np.diag([*scale, 1.0])))
    expected = 4.0 * math.pi * EMISSION.sum() * volume_of(BALL) * abs(np.prod(scale))
    assert flux["emitted"] == pytest.approx(expected, rel=0.01)
    assert flux["escaped"] == pytest.approx(flux["emitted"], rel=1e-5)


@pytest.mark.parametrize("thickness", [0.3, 2.0])
def test_light_that_escapes_from_an_absorbing_ball(renderer, thickness):
    """A fraction of 3 / (8 t^3) (2 t^2 - 1 + (2 t + 1) exp(-2 t)), t being the optical thickness of the radius."""
    flux = flux_of(renderer, (BALL, fog.fog(0.0, thickness, emission=EMISSION), np.eye(4)))
    t = thickness
    expected = 3.0 / (8.0 * t**3) * (2.0 * t * t - 1.0 + (2.0 * t + 1.0) * math.exp(-2.0 * t))
    assert flux["escaped"] / flux["emitted"] == pytest.approx(expected, rel=0.01)


@pytest.mark.parametrize("surface", ["volume alone", "glass"])
def test_flux_balances_where_media_scatter_their_light(renderer, surface):
    """Boxes that share a part, and one within the other."""
    fogs = [
        fog.fog((0.5, 1.0, 2.0), (0.3, 0.1, 0.0), 0.5, emission=EMISSION),
        fog.fog(0.4, (0.0, 0.5, 1.0), emission=1.0),
        fog.fog(1.0, 0.2, emission=(0.0, 0.0, 2.0)),
    ]
    if surface == "glass":
        for filled in fogs:
            filled.graph = material("glass", Lobe(LobeKind.GLASS, ior=1.4, color=(0.9, 0.8, 1.0))).graph
    halves, places = (1.0, 0.4, 0.8), ((0.0, 0.0, 0.0), (0.1, 0.0, 0.2), (0.9, 0.5, 0.1))
    parts = [
        (scenes.box("box", half), filled, scenes.placed(*at, 1.0))
        for half, filled, at in zip(halves, fogs, places, strict=True)
    ]
    floor = scenes.square("floor", 3.0), scenes.diffuse(0.8, 0.5, 0.3), scenes.placed(0.0, 0.0, -1.2, 1.0)
    flux = flux_of(renderer, *parts, floor)
    emitted = (EMISSION.sum(), 3.0, 2.0)
    expected = 4.0 * math.pi * sum(e * (2.0 * half) ** 3 for e, half in zip(emitted, halves, strict=True))
    assert flux["emitted"] == pytest.approx(expected, rel=0.02)


def test_boxes_of_one_material_that_overlap_emit_twice(renderer):
    scene = fog.scene_of(CAMERA, (scenes.box("box"), fog.fog(0.0, emission=EMISSION), np.eye(4)))
    scene.instances = [Instance(0, scenes.placed(x, 0.1, x, 1.0), [0]) for x in (0.0, 0.5)]
    flux = renderer.render(scene).statistics.flux_watts
    assert flux["emitted"] == pytest.approx(4.0 * math.pi * EMISSION.sum() * 16.0, rel=1e-3)


def graded(slope: float, offset: float) -> Material:
    """A medium without extinction whose emission is a multiple of z, plus an offset, in the space of the object."""
    graph = NodeGraph()
    parts = graph.add("separate_xyz", "z", vector=graph.add("tex_coord", "object"))
    options = {"operation": "MULTIPLY_ADD"}
    strength = graph.add("math", "value", options=options, value=parts, value_001=slope, value_002=offset)
    graph.surface = graph.add("emission", "emission", color=tuple(EMISSION), strength=strength)
    return Material("graded", fog.fog(0.0).graph, graph)


@pytest.mark.parametrize("mesh", [pytest.param(scenes.box("box"), marks=pytest.mark.long), BALL], ids=["box", "ball"])
def test_flux_of_a_medium_that_varies(renderer, mesh):
    turned = scenes.placed(0.3, 0.2, 0.1, 0.5) @ np.array([[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])
    flux = flux_of(renderer, (mesh, graded(1.0, 1.0), turned))
    mean = 1.0  # in the middle
    assert flux["emitted"] == pytest.approx(4.0 * math.pi * EMISSION.sum() * mean * volume_of(mesh) / 8.0, rel=0.02)
    assert flux["escaped"] == pytest.approx(flux["emitted"], rel=1e-5)


@pytest.mark.long
@pytest.mark.parametrize("use_final_gather", [True, False])
@pytest.mark.parametrize("varies", [False, True])
def test_a_floor_below_a_thin_ball(renderer, use_final_gather, varies):
    """By the shell theorem the ball shines on what is outside as if all of it were in its middle."""
    radius, height = 0.5, 1.0
    glow = graded(0.0, 1.0) if varies else fog.fog(0.0, emission=EMISSION)
    floor = scenes.square("floor", 1.5), scenes.diffuse(0.6, 0.6, 0.6), np.eye(4)
    camera = fog.camera((0.0, -1.2, 0.4), (0.0, 0.0, 0.0), 0.2)
    scene = fog.scene_of(camera, floor, (BALL, glow, scenes.placed(0.0, 0.0, height, radius)))
    scene.settings = scene.settings.with_values(
        iterations=128 if use_final_gather else 16,
        photons=64 if use_final_gather else 32768,  # the rays of final gathers alone bring this light
        use_final_gather=use_final_gather,
        max_bounces=1,
    )
    origin, way = fog.rays(camera)
    place = origin + way * (origin[2] / -way[..., 2:])
    distance2 = height**2 + (place[..., :2] ** 2).sum(axis=-1)
    irradiance = volume_of(BALL) * radius**3 * height / distance2**1.5
    expected = 0.6 / math.pi * irradiance[..., None] * EMISSION
    pictures = fog.pictures_of(renderer, scene, seeds=4)
    fog.assert_expected(pictures, expected, 0.02, bias=0.01)


def test_light_that_media_are_hidden_from(renderer):
    """Fog scatters no light of an object that is invisible to it."""
    fogged = scenes.box("fog", 1.0), fog.fog(0.5), np.eye(4)
    glow = scenes.box("glow", 0.2), fog.fog(0.0, emission=20.0), scenes.placed(0.0, 0.0, 2.0, 1.0)
    camera = fog.camera((0.0, -4.0, 0.0), (0.0, 0.0, 0.0), 0.1)
    scene = fog.scene_of(camera, fogged, glow, photons=16384, iterations=4, volume_bounces=0)
    seen = renderer.render(scene).frame.combined[..., :3].mean()
    visibility = RayVisibility.ALL & ~RayVisibility.VOLUME_SCATTER
    scene.instances = [scene.instances[0], dataclasses.replace(scene.instances[1], visibility=visibility)]
    hidden = renderer.render(scene).frame.combined[..., :3].mean()
    assert seen > 0.01
    assert hidden == 0.0


def test_a_world_that_absorbs_and_shines(renderer):
    """A furnace: a white floor that takes light and sends it on looks as the medium does, emission / absorption."""
    floor = scenes.square("floor", 1.0), scenes.diffuse(1.0, 1.0, 1.0), np.eye(4)
    volume = fog.volume(0.0, 2.0, emission=EMISSION)
    camera = fog.camera((0.3, -0.4, 0.5), (0.0, 0.0, 0.0), 0.2)
    scene = fog.scene_of(camera, floor, world=World(volume=volume), photons=16384, iterations=8, max_bounces=32)
    pictures = fog.pictures_of(renderer, scene, seeds=4)
    fog.assert_expected(pictures, EMISSION / 2.0, 0.02, bias=0.02)


def test_a_world_around_a_line_scatters_its_light(renderer):
    """A furnace with nothing in it but the camera, on an axis through the origin. Half of what is seen is scattered."""
    camera = fog.camera((0.0, -4.0, 0.0), (0.0, 0.0, 0.0), 0.3)
    world = World(volume=fog.volume(2.0, 2.0, emission=2.0))
    scene = fog.scene_of(camera, world=world, photons=65536, iterations=4, volume_bounces=64)
    assert fog.pictures_of(renderer, scene, seeds=2).mean() == pytest.approx(1.0, rel=0.2)


def test_meshes_of_earlier_scenes_are_forgotten(renderer):
    """In an animation, a body that changes its shape is another mesh in each frame."""
    frames = [scenes.box(f"box {number}") for number in range(4)]
    first = weakref.ref(frames[0])
    while frames:
        flux_of(renderer, (frames.pop(0), fog.fog(0.0, emission=EMISSION), np.eye(4)), photons=64)
    gc.collect()
    assert first() is None
