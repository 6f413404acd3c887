# SPDX-License-Identifier: GPL-3.0-or-later
"""Both routes of density estimation, rasterized splatting and photon grids, give the same bits."""

import dataclasses
from weakref import WeakKeyDictionary

import numpy as np
import pytest
import scenes
from support.lobes import Lobe, LobeKind, material
from test_render_state import busy_room
from test_shutter import everything_moves

from rppm_addon.integrator.common import band
from rppm_addon.integrator.common.records import PhotonFlag
from rppm_addon.integrator.density_estimation import density_estimator
from rppm_addon.integrator.density_estimation.density_estimator import DensityEstimator
from rppm_addon.scene import (
    Aperture,
    Camera,
    DensityEstimation,
    DirectLight,
    Image,
    LightKind,
    Panorama,
    PanoramaKind,
    Scene,
)

ITERATIONS = 3
WIDTH, HEIGHT = 36, 24


def wide(scene: Scene, **settings: object) -> Scene:
    camera = dataclasses.replace(scene.camera, width=WIDTH, height=HEIGHT)
    return dataclasses.replace(scene, camera=camera, settings=dataclasses.replace(scene.settings, **settings))


def busy(**settings: object) -> Scene:
    """Caustics, light between walls, rough and glossy paths, a pane that ends some paths."""
    return wide(busy_room(), **{"photons": 2000, "use_splat_roulette": False, "radius_scale": 40.0, **settings})


def panorama() -> Scene:
    scene = busy()
    camera = Camera(
        scenes.placed(0.1, -0.2, 0.0), (0, 1, 0, 1), WIDTH, HEIGHT, panorama=Panorama(PanoramaKind.EQUIRECTANGULAR)
    )
    return dataclasses.replace(scene, camera=camera)


def lens() -> Scene:
    scene = busy()
    scene.camera.aperture = Aperture(0.1, 3.0)
    return scene


def orthographic() -> Scene:
    scene = busy()
    scene.camera.orthographic, scene.camera.window = True, (-1.2, 1.2, -0.8, 0.8)
    return scene


def looking_back() -> Scene:
    """A wall that shows what it is made of by the angle to the viewer."""
    scene = busy()
    facing = material("facing", Lobe(LobeKind.DIFFUSE, color=(0.2, 0.8, 0.3)), Lobe(LobeKind.GLOSSY, roughness=0.3))
    graph = facing.graph
    share = graph.add("layer_weight", "facing", blend=0.5)
    graph.surface = graph.add("mix_shader", "shader", fac=share, shader_001=graph.surface)
    scene.materials[0] = facing
    return scene


def catching() -> Scene:
    scene = busy()
    scene.instances[0] = dataclasses.replace(scene.instances[0], shadow_catcher=True)
    return scene


def textured_emitter() -> Scene:
    scene = busy()
    pixels = np.random.default_rng(5).random((4, 4, 4), np.float32)
    scene.images.append(Image("glow", pixels))
    scene.materials[2] = material("glow", Lobe(LobeKind.EMISSION, color=(2, 1, 0.5), color_image=0))
    return scene


def scaled(factor: float) -> Scene:
    """All lengths times a factor."""
    scene = busy()
    grown = np.diag([factor, factor, factor, 1.0])

    def placed(matrix: np.ndarray) -> np.ndarray:
        result = matrix.copy()
        result[:3, 3] *= factor
        return result

    instances = [dataclasses.replace(item, matrix=grown @ item.matrix) for item in scene.instances]
    lights = [
        dataclasses.replace(
            light,
            matrix=placed(light.matrix),
            size=tuple(factor * side for side in light.size),
            strength=light.strength * (factor**2 if light.kind is LightKind.POINT else 1.0),
        )
        for light in scene.lights
    ]
    camera = dataclasses.replace(
        scene.camera,
        matrix=placed(scene.camera.matrix),
        clip_start=factor * scene.camera.clip_start,
        clip_end=factor * scene.camera.clip_end,
    )
    return dataclasses.replace(scene, instances=instances, lights=lights, camera=camera)


SCENES = {
    "room": lambda: wide(scenes.room(8, photons=2000)),
    "busy": busy,
    "roulette": lambda: busy(use_splat_roulette=True),
    "photons for direct light": lambda: busy(direct_light=DirectLight.PHOTONS),
    "without final gather": lambda: busy(use_final_gather=False, direct_light=DirectLight.PHOTONS),
    "roulette without final gather": lambda: busy(use_final_gather=False, use_splat_roulette=True),
    "one segment": lambda: busy(camera_path_length=1),
    "wide radius": lambda: busy(radius_scale=400.0),
    "radii far apart": lambda: busy(radius_minimum=0.001, radius_maximum=0.3, direct_light=DirectLight.PHOTONS),
    "panorama": panorama,
    "lens": lens,
    "orthographic": orthographic,
    "motion": lambda: everything_moves(busy(), 1.0),
    "looking back": looking_back,
    "shadow catcher": catching,
    "textured emitter": textured_emitter,
    "small": lambda: scaled(1e-4),
    "huge": lambda: scaled(3e4),
    "dark": lambda: dataclasses.replace(busy(), lights=[]),
}


def rendered(mapper, scene: Scene, route: DensityEstimation) -> list[np.ndarray]:
    """The film, the radii, how many photons the last pixels took in each iteration, and which of its photons
    contributed."""
    scene = dataclasses.replace(scene, settings=dataclasses.replace(scene.settings, density_estimation=route))
    mapper.build(scene)
    found = []
    for _ in range(ITERATIONS):
        mapper.iterate()
        photons = mapper.read_photons()
        found += [mapper.stages.density_estimator.sums.photons_taken(mapper.stages.bands[-1].pixel_count)]
        found += [(photons["contributed"] != 0) & (photons["flags"] & PhotonFlag.STORED != 0)]
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
        assert rasterized[4].sum() > 50, "next to no photon was taken: the test shows nothing"


@pytest.fixture
def undecided(monkeypatch):
    monkeypatch.setattr(density_estimator, "_faster", WeakKeyDictionary())
    monkeypatch.setattr(density_estimator, "_may_rasterize", lambda context: True)


@pytest.mark.parametrize("rasterized_takes", [0.5, 2.0])
def test_the_faster_route_is_taken_and_kept(mapper, other_mapper, monkeypatch, undecided, rasterized_takes):
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
    other_mapper.build(wide(scenes.room(8, photons=2000)))
    other_mapper.iterate()
    assert not tried and other_mapper.density_estimation is faster
    for each in (mapper, other_mapper):
        assert ("splat jobs" in each.memory_bytes) == (faster is DensityEstimation.RASTERIZED)
        assert ("sorted photons" in each.memory_bytes) == (faster is DensityEstimation.GRID)


def test_nothing_is_tried_with_next_to_nothing(mapper, monkeypatch, undecided):
    monkeypatch.setattr(DensityEstimator, "_seconds", lambda *_: pytest.fail("both were tried"))
    mapper.build(wide(scenes.room(8, photons=500)))
    mapper.iterate()
    assert mapper.density_estimation is DensityEstimation.GRID


def test_nothing_is_tried_where_no_unit_rasterizes(mapper, monkeypatch, undecided):
    monkeypatch.setattr(density_estimator, "_may_rasterize", lambda context: False)
    monkeypatch.setattr(density_estimator, "_FEWEST_TO_TRY", 100)
    monkeypatch.setattr(DensityEstimator, "_seconds", lambda *_: pytest.fail("both were tried"))
    mapper.build(busy())
    mapper.iterate()
    assert mapper.density_estimation is DensityEstimation.GRID
