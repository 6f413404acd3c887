# SPDX-License-Identifier: GPL-3.0-or-later
"""Ray portals: where paths go on, and scenes behind them whose radiance is known."""

import dataclasses

import numpy as np
import pytest
import scenes
from rendering import radiance_of
from support.lobes import Lobe, LobeKind, material

from rppm_addon.scene import (
    AccelerationStructure,
    DirectLight,
    Instancing,
    Light,
    LightKind,
    Link,
    Material,
    NodeGraph,
    Scene,
    World,
)

AWAY = (7.0, 3.0, -2.0)
TINT = np.array([0.5, 0.8, 1.0])
CENTERS = {"filter_width": 0.0, "photons": 64}


def portal(
    way: tuple | None = AWAY,
    direction: tuple = (0.0, 0.0, 0.0),
    color: tuple = (1.0, 1.0, 1.0),
    beside: Lobe | None = None,
    fraction: float = 0.5,
) -> Material:
    """A surface from which paths go on a way off, in a direction. beside: another lobe, mixed with it by a fraction."""
    graph = NodeGraph()
    inputs: dict[str, object] = {"color": color, "direction": direction}
    if way is not None:
        place = graph.add("new_geometry", "position")
        inputs["position"] = graph.add(
            "vector_math", "vector", options={"operation": "ADD"}, vector=place, vector_001=way
        )
    graph.surface = graph.add("bsdf_ray_portal", "bsdf", **inputs)
    if beside is None:
        return Material("portal", graph)
    other = material("other", beside).graph
    count = len(graph.nodes)
    graph.nodes += [dataclasses.replace(node, inputs=shifted(node.inputs, count)) for node in other.nodes]
    graph.surface = graph.add(
        "mix_shader", "shader", fac=fraction, shader=graph.surface,
        shader_001=Link(other.surface.node + count, other.surface.output),
    )  # fmt: skip
    return Material("portal", graph)


def shifted(inputs: dict, count: int) -> dict:
    """Inputs of a node whose links are to nodes of higher numbers."""
    return {
        name: Link(value.node + count, value.output) if isinstance(value, Link) else value
        for name, value in inputs.items()
    }


def glow(radiance: float) -> Material:
    return material("glow", Lobe(LobeKind.EMISSION, color=(radiance,) * 3))


def window(surface: Material, **settings: object) -> Scene:
    """A camera that looks down at a window; at the other place a square of radiance 3 lies below, and one of radiance 5
    beside."""
    x, y, z = AWAY
    below = scenes.rectangle(
        "below", (x - 2, y - 2, z - 1), (x + 2, y - 2, z - 1), (x + 2, y + 2, z - 1), (x - 2, y + 2, z - 1)
    )
    beside = scenes.rectangle(
        "beside", (x + 3, y - 2, z - 1), (x + 3, y + 2, z - 1), (x + 3, y + 2, z + 1), (x + 3, y - 2, z + 1)
    )
    camera = scenes.camera((0.0, 0.0, 2.0), (0.0, 0.0, 0.0), 0.2, 8)
    return scenes.scene_of(
        camera, (scenes.square("window", 1.0), surface), (below, glow(3.0)), (beside, glow(5.0)), **CENTERS | settings
    )


@pytest.mark.parametrize(
    ("surface", "radiance"),
    [
        (portal(), 3.0),
        (portal(color=(0.5, 0.5, 0.5)), 1.5),
        (portal(direction=(2.0, 0.0, 0.0)), 5.0),
        (portal(direction=(0.0, 0.0, 4.0)), 0.0),
        (portal(way=None), 0.0),
        (portal(way=(0.0, 0.0, 0.5)), 0.0),
    ],
    ids=["straight", "gray", "turned", "up", "in place", "onto itself"],
)
@pytest.mark.parametrize("structure", [AccelerationStructure.DEEP_CUBEMAP, AccelerationStructure.BVH])
def test_a_path_goes_on_elsewhere(mapper, surface, radiance, structure):
    """One that is led above its window comes back to it, again and again, until its limit."""
    picture = radiance_of(mapper, window(surface, acceleration_structure=structure))
    np.testing.assert_allclose(picture[..., :3], radiance, rtol=1e-5)


def test_instances_that_share_their_triangles_are_met_from_there(mapper):
    scene = window(portal(color=tuple(TINT)), instancing=Instancing.TWO_LEVELS)
    np.testing.assert_allclose(radiance_of(mapper, scene)[..., :3], np.broadcast_to(3.0 * TINT, (8, 8, 3)), rtol=1e-5)


def test_a_window_in_place_shows_what_lies_behind(mapper):
    scene = window(portal(way=None))
    scenes.add(scene, scenes.square("behind", 1.0, -0.5), glow(2.0))
    np.testing.assert_allclose(radiance_of(mapper, scene)[..., :3], 2.0, rtol=1e-5)


@pytest.mark.parametrize(("limit", "radiance"), [(0, 0.0), (1, 3.0)])
def test_windows_count_among_transparent_surfaces(mapper, limit, radiance):
    picture = radiance_of(mapper, window(portal(), transparent_max_bounces=limit))
    np.testing.assert_allclose(picture[..., :3], radiance, rtol=1e-5)


@pytest.mark.parametrize(
    ("beside", "radiance"),
    [
        (Lobe(LobeKind.EMISSION, color=(1.0, 1.0, 1.0)), 2.0),
        (Lobe(LobeKind.TRANSPARENT, color=(1.0, 1.0, 1.0)), 2.5),
        (Lobe(LobeKind.GLOSSY, color=(1.0, 1.0, 1.0), roughness=0.0), 1.8),
        (Lobe(LobeKind.PRINCIPLED, color=(0.0, 0.0, 0.0), roughness=0.3, inputs={"specular_ior_level": 0.0}), 1.5),
    ],
    ids=["emission", "transparent", "mirror", "principled"],
)
def test_mixed_with_others(mapper, beside, radiance):
    """Half of the light comes from elsewhere. The rest is what the other lobe shows: its own emission, a square of
    radiance 2 behind, or a lid of 0.6 above."""
    scene = window(portal(beside=beside))
    scenes.add(scene, scenes.square("behind", 1.0, -0.5), glow(2.0))
    lid = scenes.square("above", 9.0, 4.0)
    scenes.add(scene, lid, glow(0.6))
    picture = radiance_of(mapper, scene, 64)[..., :3]
    np.testing.assert_allclose(picture.mean(), radiance, rtol=0.01)


def test_a_transparent_film_shows_its_background(mapper):
    """The background counts by what a window to nowhere lets pass; the window itself covers the rest."""
    picture = radiance_of(mapper, window(portal(way=(0.0, 0.0, -9.0), color=tuple(TINT)), film_transparent=True))
    np.testing.assert_allclose(picture, np.broadcast_to([0.0, 0.0, 0.0, 1.0 - TINT.mean()], picture.shape), atol=1e-5)


def furnace(albedo: float, **settings: object) -> Scene:
    """Two cubes that glow and reflect on the inside. One wall of each is a window into the other: radiance is
    1 / (1 - albedo) everywhere. Each window leads to just behind the other."""
    lobes = Lobe(LobeKind.DIFFUSE, color=(albedo,) * 3), Lobe(LobeKind.EMISSION, color=(1.0, 1.0, 1.0))
    camera = scenes.camera((0.3, 0.2, 0.1), (-1.0, -0.4, -0.1), 0.8, 16)
    scene = scenes.scene_of(camera, **{"photons": 4096, "camera_path_length": 16, "photon_path_length": 16} | settings)
    scene.settings = scene.settings.with_values(max_bounces=16)
    for x, side in ((0.0, 1.0), (6.0, -1.0)):
        corners = np.array([(0.0, -1.0, -1.0), (0.0, 1.0, -1.0), (0.0, 1.0, 1.0), (0.0, -1.0, 1.0)])
        # A window in the wall at x + side leads to where the other cube's window is.
        for axis in range(3):
            for sign in (-1.0, 1.0):
                wall = np.roll(corners, axis, axis=1)
                wall[:, axis] = sign
                is_window = axis == 0 and sign == side
                surface = portal(((4.0 + 1e-3) * side, 0.0, 0.0)) if is_window else material("wall", *lobes)
                shape = scenes.rectangle(f"{x} {axis} {sign}", *map(tuple, wall + (x, 0.0, 0.0)))
                scenes.add(scene, shape, surface)
    return scene


@pytest.mark.parametrize(
    ("direct_light", "tolerance"),
    [(DirectLight.RAYS, 0.01), pytest.param(DirectLight.PHOTONS, 0.03, marks=pytest.mark.long)],
)
def test_light_goes_to_and_fro(mapper, direct_light, tolerance):
    """Rays find all light that comes through windows, after any number of bounces on either side."""
    picture = radiance_of(mapper, furnace(0.5, direct_light=direct_light), 24)[..., :3]
    np.testing.assert_allclose(picture.mean(), 2.0, rtol=tolerance)


def test_the_sky_through_windows_lights_a_floor(mapper):
    """The walls and the lid of a box around a floor of albedo 0.6 are windows to an even sky."""
    floor = scenes.square("floor", 1.0)
    camera = scenes.camera((0.0, -0.3, 0.9), (0.0, 0.0, 0.0), 0.3, 8)
    scene = scenes.scene_of(
        camera, (floor, scenes.diffuse(0.6, 0.6, 0.6)), (scenes.box("box", 1.0), portal((0.0, 0.0, 50.0))),
        world=World(np.ones(3)), photons=256,
    )  # fmt: skip
    picture = radiance_of(mapper, scene, 32)[..., :3]
    np.testing.assert_allclose(picture.mean(), 0.6, rtol=0.01)


@pytest.mark.parametrize("direct_light", list(DirectLight))
def test_windows_cast_shadows(mapper, direct_light):
    """Neither shadow rays nor photons go through, as they do where the window is clear."""
    camera = scenes.camera((0.0, -2.5, -0.5), (0.0, -1.0, -1.0), 0.05, 8)
    lamp = Light("lamp", LightKind.POINT, scenes.placed(0.0, 0.0, 3.0), np.full(3, 10.0))

    def seen(*windows: Material) -> np.ndarray:
        parts = [(scenes.square("floor", 3.0, -1.0), scenes.diffuse(0.8, 0.8, 0.8))]
        parts += [(scenes.square("window", 1.5), window) for window in windows]
        scene = scenes.scene_of(camera, *parts, lights=[lamp], photons=1 << 16, direct_light=direct_light)
        return radiance_of(mapper, scene, 4)[..., :3]

    clear = material("clear", Lobe(LobeKind.TRANSPARENT, color=(1.0, 1.0, 1.0)))
    assert seen(portal(way=None)).max() == 0.0
    np.testing.assert_allclose(seen(clear).mean(), seen().mean(), rtol=0.03)
