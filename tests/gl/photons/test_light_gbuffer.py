# SPDX-License-Identifier: GPL-3.0-or-later
"""First hits of photons from light G-buffers are those of the deep cubemap, bit for bit."""

import dataclasses
import math

import numpy as np
import pytest
import scenes
from busy_scenes import SCENES, busy, wide
from rendering import iterated, radiance_of

from rppm_addon.integrator.common.records.photon_paths import PhotonFlag
from rppm_addon.integrator.photons import first_hits, light_gbuffer
from rppm_addon.integrator.photons.first_hits import FirstHits
from rppm_addon.scene import FirstPhotonHits, Instance, Light, LightKind, Scene

PHOTONS = 16384
ONE = np.ones(3)


def aimed(position: tuple[float, float, float], target: tuple[float, float, float]) -> np.ndarray:
    return scenes.looking(position, target)


ABOVE = aimed((0.3, -0.2, 0.8), (0.1, 0.1, -1.0))
STRETCHED = ABOVE @ np.diag([2.0, 0.7, 1.0, 1.0])
OUTSIDE = aimed((4.0, -3.0, 5.0), (0.0, 0.0, 0.0))
LIGHTS = {
    "point": Light("point", LightKind.POINT, ABOVE, ONE),
    "small sphere": Light("small sphere", LightKind.POINT, ABOVE, ONE, radius=0.005),
    "point outside": Light("point outside", LightKind.POINT, OUTSIDE, ONE),
    "narrow spot": Light("narrow spot", LightKind.SPOT, ABOVE, ONE, spot_angle=0.3),
    "spot": Light("spot", LightKind.SPOT, ABOVE, ONE, spot_angle=1.6, spot_blend=0.5),
    "stretched spot": Light("stretched spot", LightKind.SPOT, STRETCHED, ONE, spot_angle=1.0),
    "soft spot": Light("soft spot", LightKind.SPOT, ABOVE, ONE, spot_angle=1.6, radius=0.005, soft_falloff=True),
    "wide spot": Light("wide spot", LightKind.SPOT, ABOVE, ONE, spot_angle=3.0),
    "spot outside": Light("spot outside", LightKind.SPOT, OUTSIDE, ONE, spot_angle=0.8),
    "sun": Light("sun", LightKind.SUN, OUTSIDE, ONE),
    "sun along an axis": Light("sun along an axis", LightKind.SUN, aimed((1, 0, 0), (0, 0, 0)), ONE),
    "sun's disk": Light("sun's disk", LightKind.SUN, OUTSIDE, ONE, sun_angle=math.radians(0.53)),
}
TRACED_LIGHTS = {
    "sphere": Light("sphere", LightKind.POINT, ABOVE, ONE, radius=0.2),
    "wide sun": Light("wide sun", LightKind.SUN, OUTSIDE, ONE, sun_angle=0.3),
    "square": Light("square", LightKind.AREA, ABOVE, ONE, size=(0.4, 0.4)),
}


def open_room(lights: list[Light]) -> Scene:
    """Walls, a finely meshed sphere and slivers, some of them across the lights; the roof has a hole."""
    scene = wide(scenes.room(8, photons=PHOTONS))
    random = np.random.default_rng(7)
    middle = random.uniform(-1.0, 1.0, (300, 1, 3))
    corners = middle + random.uniform(-0.2, 0.2, (300, 3, 3)) * 10.0 ** random.uniform(-5, 0.5, (300, 3, 1))
    soup = scenes.polygons("soup", corners.reshape(-1, 3), [(3 * k, 3 * k + 1, 3 * k + 2) for k in range(300)])
    meshes = [*scene.meshes, scenes.sphere("sphere", 64, 32), soup]
    instances = [
        *scene.instances,
        Instance(len(meshes) - 2, scenes.placed(-0.2, 0.3, -0.4, 0.4), [0]),
        Instance(len(meshes) - 1, np.eye(4), [0]),
    ]
    return dataclasses.replace(scene, meshes=meshes, instances=instances, lights=lights)


def photons_of(mapper, scene: Scene, route: FirstPhotonHits) -> np.ndarray:
    """(segments, photons) records of the second iteration, where a guide aims the photons."""
    return iterated(mapper, with_route(scene, route), 2).read_photons()


def assert_same_photons(mapper, scene: Scene, route: FirstPhotonHits = FirstPhotonHits.RASTERIZED) -> None:
    """Photons by light G-buffers are those of traced rays, bit for bit; route: the one that is taken in the end."""
    traced = photons_of(mapper, scene, FirstPhotonHits.TRACED)
    np.testing.assert_array_equal(photons_of(mapper, scene, FirstPhotonHits.RASTERIZED).tobytes(), traced.tobytes())
    assert mapper.first_photon_hits is route
    assert np.mean(traced[0]["flags"] & PhotonFlag.ESCAPED == 0) > 0.1, "the test shows nothing"


@pytest.mark.parametrize("name", LIGHTS)
def test_hits_are_those_of_traced_rays(mapper, name):
    assert_same_photons(mapper, open_room([LIGHTS[name]]))


@pytest.mark.parametrize("name", TRACED_LIGHTS)
def test_lights_of_some_extent_are_traced(mapper, name):
    assert_same_photons(mapper, open_room([TRACED_LIGHTS[name]]), FirstPhotonHits.TRACED)


def test_of_many_lights_some_are_rasterized(mapper, monkeypatch):
    monkeypatch.setattr(light_gbuffer, "MAX_LIGHTS", 5)
    assert_same_photons(mapper, open_room([*LIGHTS.values(), *TRACED_LIGHTS.values()]))


def with_route(scene: Scene, route: FirstPhotonHits) -> Scene:
    return dataclasses.replace(scene, settings=dataclasses.replace(scene.settings, first_photon_hits=route))


def rendered(mapper, scene: Scene, route: FirstPhotonHits) -> np.ndarray:
    return radiance_of(mapper, with_route(scene, route), 3).view(np.uint32)


@pytest.mark.parametrize(
    "name", ["busy", "photons for direct light", "panorama", "motion", "looking back", "small", "huge", "dark"]
)
def test_both_routes_give_the_same_picture(mapper, name):
    scene = SCENES[name]()
    traced = rendered(mapper, scene, FirstPhotonHits.TRACED)
    assert mapper.first_photon_hits is FirstPhotonHits.TRACED and "light G-buffer" not in mapper.memory_bytes
    np.testing.assert_array_equal(rendered(mapper, scene, FirstPhotonHits.RASTERIZED), traced)
    if name != "dark":
        assert mapper.first_photon_hits is FirstPhotonHits.RASTERIZED
        assert mapper.memory.working["photon paths"]["light G-buffer"] >= 12 * 128 * 128


@pytest.mark.parametrize("rasterized_takes", [0.5, 2.0])
def test_the_faster_route_is_taken_until_the_lights_change(mapper, monkeypatch, rasterized_takes):
    monkeypatch.setattr(first_hits, "_TRACED_BEFORE_TRIAL", 1)
    expected = rendered(mapper, busy(), FirstPhotonHits.TRACED)
    tried = []
    seconds = FirstHits._seconds

    def pretended(self, route, *arguments):
        seconds(self, route, *arguments)
        tried.append(route)
        return rasterized_takes if route is FirstPhotonHits.RASTERIZED else 1.0

    monkeypatch.setattr(FirstHits, "_seconds", pretended)
    scene = busy()
    np.testing.assert_array_equal(rendered(mapper, scene, FirstPhotonHits.AUTOMATIC), expected)
    faster = FirstPhotonHits.RASTERIZED if rasterized_takes < 1.0 else FirstPhotonHits.TRACED
    assert mapper.first_photon_hits is faster and set(tried) == set(FirstPhotonHits) - {FirstPhotonHits.AUTOMATIC}
    trials = len(tried)
    camera = dataclasses.replace(scene.camera, window=(-0.5, 0.5, -0.4, 0.4))
    scene = dataclasses.replace(mapper.scene, camera=camera)
    mapper.update(scene)
    mapper.iterate()
    assert len(tried) == trials and mapper.first_photon_hits is faster
    mapper.update(dataclasses.replace(scene, lights=scene.lights[1:]))
    mapper.iterate()
    assert mapper.first_photon_hits is FirstPhotonHits.TRACED
    mapper.iterate()
    assert len(tried) == 2 * trials
