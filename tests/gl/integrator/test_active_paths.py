# SPDX-License-Identifier: GPL-3.0-or-later
"""Lists of active paths against NumPy, and pictures from them against pictures that run every path in every segment."""

import dataclasses

import numpy as np
import pytest
import scenes
from support.lobes import Lobe, LobeKind, image_world, material

from rppm_addon.integrator.common import band
from rppm_addon.integrator.common.active_paths import ACTIVE_PATHS_HEADER, ActivePaths
from rppm_addon.integrator.common.records.rays import RAY
from rppm_addon.scene import Aperture, DirectLight, Image, Movement, Panorama, PanoramaKind, Scene, Shutter
from rppm_addon.scene.lights import Light, LightKind

SIZE = 20


def device_rays(context, alive: np.ndarray):
    rays = RAY.zeros(len(alive))
    rays["maximum_distance"] = np.where(alive, 1e30, 0.0)
    return context.moderngl.buffer(rays.tobytes())


def header(paths: ActivePaths) -> np.void:
    return np.frombuffer(paths.buffer.read(ACTIVE_PATHS_HEADER.size), ACTIVE_PATHS_HEADER.dtype)[0]


@pytest.mark.parametrize("count", [1, 64, 65, 5000])
def test_lists_hold_what_lives(context, library, count):
    rng = np.random.default_rng(count)
    paths, taken = (ActivePaths(context, library, name, "take fewer") for name in ("paths", "rays"))
    paths.require(count, to_keep=True)
    paths.fill(count)
    np.testing.assert_array_equal(paths.read(), np.arange(count))
    alive = np.ones(count, bool)
    for share in (1.0, 0.9, 0.3, 0.02, 0.0):
        alive &= rng.random(count) < share
        paths.keep(device_rays(context, alive))
        aims = rng.random(count) < 0.5
        taken.take(paths, device_rays(context, aims))
        for listed, expected in ((paths, alive), (taken, alive & aims)):
            assert listed.capacity == count
            np.testing.assert_array_equal(np.sort(listed.read()), np.nonzero(expected)[0])
            groups = -(-int(expected.sum()) // 64)
            assert header(listed)["groups"].tolist() == [groups, min(groups, 1), 1]
    paths.keep(device_rays(context, alive))  # a dispatch of no groups
    assert not paths.read_count()
    assert paths.known_empty == context.is_software
    paths.release()
    taken.release()


@pytest.mark.parametrize("is_software", [True, False])
def test_a_device_is_asked_once_in_a_segment(context, library, monkeypatch, is_software):
    """A GPU in every fourth."""
    paths = ActivePaths(context, library, "paths", "take fewer")
    paths.require(64, to_keep=True)
    paths.fill(64)
    lived, asked = {number: 64 - number for number in range(9)}, []

    def count(_: ActivePaths) -> int:
        asked.append(now)
        return lived[now]

    with monkeypatch.context() as patch:
        patch.setattr(ActivePaths, "read_count", count)
        patch.setitem(vars(context), "is_software", is_software)
        for now in lived:
            known = lived[now if is_software else now - now % 4]
            assert (paths.bound(now), paths.bound(now)) == (known, known)
    assert asked == (list(range(1, 9)) if is_software else [4, 8])
    paths.release()


def test_long_lists_are_dispatched_in_rows(context, library):
    """One group more than a row of them holds."""
    count = 65535 * 64 + 1
    paths = ActivePaths(context, library, "paths", "take fewer")
    paths.require(count, to_keep=True)
    paths.fill(count)
    assert header(paths)["groups"].tolist() == [65535, 2, 1]
    paths.keep(device_rays(context, np.ones(count, bool)))
    assert header(paths)["groups"].tolist() == [65535, 2, 1]
    np.testing.assert_array_equal(np.sort(paths.read()), np.arange(count))
    paths.release()


def shown_by(kind: str) -> Scene:
    """An open room with a glass and a mirror ball, in which paths end at different segments."""
    scene = scenes.room(SIZE, photons=1500, camera_path_length=6, photon_path_length=6, radius_scale=60.0, seed=5)
    settings = scene.settings
    glow = np.random.default_rng(0).integers(0, 255, (4, 4, 4), np.uint8)
    scene.images = [Image("glow", glow, "SRGB")]
    if kind == "splat roulette":
        settings.use_splat_roulette = True
    elif kind == "photons alone":
        settings.direct_light, settings.use_final_gather = DirectLight.PHOTONS, False
    elif kind == "panorama in a world":
        scene.world = image_world(0)
        scene.camera.window = (0.0, 1.0, 0.0, 1.0)
        scene.camera.panorama = Panorama(PanoramaKind.FISHEYE_EQUIDISTANT, field_of_view=2.0)
    elif kind == "lens and motion":
        scene.camera.aperture = Aperture(0.05, 3.0)
        ways = np.array([scenes.placed(-0.4, -0.1, -0.6, 0.35), scenes.placed(-0.1, -0.1, -0.5, 0.35)])
        scene = dataclasses.replace(scene, shutter=Shutter(np.ones(4), [Movement(5, np.array([0.0, 1.0]), ways)]))
    elif kind == "shadow catcher":
        scene.instances[0] = dataclasses.replace(scene.instances[0], shadow_catcher=True)
        settings.film_transparent = True
    elif kind == "look back at a soft light":
        facing = material("facing", Lobe(LobeKind.DIFFUSE, color=(0.9, 0.6, 0.3)))
        weight = facing.graph.add("layer_weight", "facing", blend=0.5)
        facing.graph.surface = facing.graph.add("mix_shader", "shader", fac=weight, shader_001=facing.graph.surface)
        scene.materials[0] = facing
        scene.lights = [Light("light", LightKind.POINT, scenes.placed(0, 0, 0.7), np.full(3, 2.0), radius=0.1)]
    elif kind == "textured emitter":
        scene.lights = []
        glow = material("glow", Lobe(LobeKind.EMISSION, color=(9, 9, 9), color_image=0))
        scenes.add(scene, scenes.inside_out(scenes.square("light", 0.3, 0.9)), glow)
    return scene


def outcome(mapper, scene: Scene) -> dict[str, np.ndarray]:
    """All that two iterations leave."""
    mapper.build(scene)
    result = {}
    for iteration in range(2):
        mapper.iterate()
        result[f"photons {iteration}"] = mapper.read_photons().view(np.uint8)
        result[f"flux {iteration}"] = np.array(list(mapper.flux_balance().values()))
    state = dataclasses.asdict(mapper.state())
    state |= state.pop("passes")
    return result | {name: np.asarray(value) for name, value in state.items()}


KINDS = (
    "bands", "splat roulette", "photons alone", "panorama in a world", "lens and motion", "shadow catcher",
    "look back at a soft light", "textured emitter",
)  # fmt: skip


@pytest.mark.parametrize("kind", KINDS)
def test_pictures_are_those_of_all_paths(mapper, other_mapper, monkeypatch, kind):
    """Bit for bit, with photons, tallies and what is counted: lists change what is run, and nothing else."""
    if kind == "bands":
        monkeypatch.setattr(band, "MAXIMUM_BAND_PIXELS", SIZE * 8)
    got = outcome(mapper, shown_by(kind))
    monkeypatch.setattr(ActivePaths, "keep", lambda paths, rays: None)
    monkeypatch.setattr(ActivePaths, "take", lambda paths, others, rays: paths.fill(others.capacity))
    expected = outcome(other_mapper, shown_by(kind))
    assert (expected["radiance"][..., :3] > 0).mean() > 0.3
    for name, value in expected.items():
        np.testing.assert_array_equal(got[name].reshape(-1), value.reshape(-1), err_msg=name)
