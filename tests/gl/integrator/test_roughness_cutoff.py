# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a lobe stores photons or is traced, and how it finds its lights, does not change the picture's mean."""

import itertools
import math

import numpy as np
import pytest
import scenes
from support.families import some_each_time
from support.lobes import Lobe, LobeKind, image_world, material

from rppm_addon.scene import DirectLight, Light, LightKind, Scene, World


def above(x: float, z: float) -> np.ndarray:
    return scenes.placed(x, 0, z)


LIGHTS = {
    "point": [Light("l", LightKind.POINT, above(1, 1.5), np.full(3, 3.0))],
    "sphere": [Light("l", LightKind.POINT, above(1, 1.5), np.full(3, 3.0), radius=0.3)],
    "soft": [Light("l", LightKind.POINT, above(1, 1.5), np.full(3, 3.0), radius=0.3, soft_falloff=True)],
    "area": [Light("l", LightKind.AREA, above(1, 1.5), np.full(3, 9.0), size=(0.5, 0.5))],
    "disk": [Light("l", LightKind.AREA, above(1, 1.5), np.full(3, 9.0), shape="DISK", size=(0.5, 0.5), spread=2.0)],
    "sun": [Light("l", LightKind.SUN, scenes.looking((0, 0, 0), (-1, 0, -1.5)), np.full(3, 2.0), sun_angle=0.4)],
    "world": [],
    "image": [],
    "mesh": [],
}


def glossy_floor(light: str, lobe: Lobe, cut: float, mode: DirectLight, final_gather: bool = True) -> Scene:
    stores = mode is DirectLight.PHOTONS and lobe.roughness > cut
    scene = scenes.scene_of(
        scenes.camera((-1.2, 0, 1.4), (0, 0, 0), 0.3, 32), (scenes.square("floor", 2.0), material("floor", lobe)),
        lights=LIGHTS[light], direct_light=mode, photon_path_length=2, camera_path_length=3, radius_minimum=0.08,
        radius_maximum=0.08, filter_width=0.0, specular_roughness=cut, use_final_gather=final_gather,
        # Camera rays find all light that photons do not.
        iterations=8 if stores else 24, photons=32768 if stores else 64,
    )  # fmt: skip
    if light == "world":
        scene.world = World(np.array([1.0, 2.0, 3.0]))
    if light == "image":
        scene.images, scene.world = [scenes.sky_with_a_sun(32, 0.01)], image_world(0)
    if light == "mesh":
        glow = material("light", Lobe(LobeKind.EMISSION, color=(9, 9, 9)))
        scenes.add(scene, scenes.rectangle("light", (1, -0.3, 1), (1, 0.3, 1), (1.2, 0.3, 1.5), (1.2, -0.3, 1.5)), glow)
    return scene


def mean(renderer, *arguments, **named) -> tuple[float, float]:
    """Mean radiance of a picture and its standard error, from the differences of neighboring pixels.

    Splats make neighbors alike, so that the error is too small for pictures by photons.
    """
    scene = glossy_floor(*arguments, **named)
    picture = renderer.render(scene).frame.combined[..., :3].mean(axis=2, dtype=np.float64)
    return float(picture.mean()), float(np.diff(picture, axis=1).std() / np.sqrt(2 * picture.size))


def assert_alike(first: tuple[float, float], second: tuple[float, float]) -> None:
    """Equal within four standard errors and half a percent."""
    assert abs(first[0] - second[0]) < 4 * math.hypot(first[1], second[1]) + 0.005 * first[0]


@pytest.mark.parametrize(
    ("roughness", "light"),
    some_each_time(
        itertools.product([0.35, 0.6], LIGHTS), lambda roughness, light: roughness == 0.35 or light in ("area", "world")
    ),
)
def test_traced_and_stored_lobes_shine_alike(renderer, light, roughness):
    lobe = Lobe(LobeKind.GLOSSY, color=(0.8, 0.8, 0.8), roughness=roughness)
    stored = mean(renderer, light, lobe, 0.0, DirectLight.RAYS, final_gather=False)  # shadow rays alone
    traced = mean(renderer, light, lobe, 1.0, DirectLight.RAYS)  # those and scattering together
    assert_alike(traced, stored)
    assert_alike(mean(renderer, light, lobe, 0.0, DirectLight.RAYS), stored)  # an environment by gathering rays too
    if light == "world":
        assert traced[1] < stored[1]  # what scattering is for: light from all around


@pytest.mark.parametrize("light", ["area", "world", "mesh"])
def test_photons_alone_shine_alike(renderer, light):
    lobe = Lobe(LobeKind.GLOSSY, color=(0.8, 0.8, 0.8), roughness=0.6)
    rays = mean(renderer, light, lobe, 1.0, DirectLight.RAYS)
    stored = mean(renderer, light, lobe, 0.0, DirectLight.PHOTONS)  # splats evaluate the lobe
    traced = mean(renderer, light, lobe, 1.0, DirectLight.PHOTONS)  # scattering alone meets the light
    assert_alike(traced, rays)
    assert stored[0] == pytest.approx(rays[0], rel=0.03)


def test_a_sweep_of_roughness_does_not_jump_at_the_cut(renderer):
    values = []
    for roughness in np.linspace(0.44, 0.56, 7):
        lobe = Lobe(LobeKind.PRINCIPLED, color=(0.5, 0.3, 0.2), roughness=float(roughness))
        values.append(mean(renderer, "area", lobe, 0.5, DirectLight.RAYS)[0])
    steps = np.diff(values) / np.mean(values)
    smooth = np.polyval(np.polyfit(np.arange(7), values, 2), np.arange(7))
    assert abs(np.array(values) / smooth - 1).max() < 0.01 and abs(steps).max() < 0.05


def test_rough_glass_passes_a_point_light(renderer):
    """Light of a point through rough glass reaches the camera by shadow rays only (LGE)."""
    scene = glossy_floor("point", Lobe(LobeKind.REFRACTION, roughness=0.4, ior=1.3), 0.5, DirectLight.RAYS)
    scene.lights = [Light("l", LightKind.POINT, above(0.2, -1.0), np.full(3, 3.0))]
    picture = renderer.render(scene).frame.combined[..., :3]
    assert math.isfinite(picture.mean()) and picture.mean() > 0.01


def swept_sheet(path: str, kind: LobeKind, mode: DirectLight, roughness: float, cut: float) -> Scene:
    """Light, the swept sheet (G), and for LDGE and LGDE a wall (D) before or after it.

    The wall is on the other side of sheets that transmit. Lights are narrow: they light only what the path names.
    """
    side = 1 if kind is LobeKind.GLOSSY else -1
    lobe = Lobe(kind, color=(0.8, 0.8, 0.8), roughness=roughness, ior=1.3)
    wall = scenes.rectangle("wall", (1, -1, 0.02 * side), (1, 1, 0.02 * side), (1, 1, 1.5 * side), (1, -1, 1.5 * side))
    light_at, light_to = {
        "LGE": ((0.6, 0, 1.2 * side), (0, 0, 0)),
        "LDGE": ((-0.8, 0, 0.75 * side), (1, 0, 0.75 * side)),
        "LGDE": ((-0.8, 0, 1), (0, 0, 0)),
    }[path]
    light = Light("light", LightKind.AREA, scenes.looking(light_at, light_to), np.full(3, 9.0), size=(0.4, 0.4))
    light.spread = math.pi if path == "LGE" else 0.5
    eye, target = ((-0.2, 0, 0.4 * side), (1, 0, 0.4 * side)) if path == "LGDE" else ((-1, 0, 1.2), (0, 0, 0))
    camera = scenes.camera(eye, target, 0.25, 32, True)
    # What camera rays alone find takes many of them and no photons.
    alone = path != "LGDE" and (cut > roughness or (path == "LGE" and mode is DirectLight.RAYS))
    if alone:
        iterations, photons = 32, 64
    elif path == "LGDE":  # gathering rays from the wall seldom meet what a sheet that stores photons shows of the light
        iterations, photons = (4, 4096) if cut > roughness else (32 if kind is LobeKind.GLOSSY else 512, 512)
    else:
        iterations, photons = 8 if path == "LDGE" else 4, 16384
    parts = [(scenes.square("sheet", 2.0), material("sheet", lobe)), (wall, scenes.diffuse(0.8, 0.8, 0.8))]
    return scenes.scene_of(
        camera, *(parts[:1] if path == "LGE" else parts), lights=[light],
        iterations=iterations, photons=photons, direct_light=mode, photon_path_length=3, camera_path_length=3,
        radius_minimum=0.05, radius_maximum=0.05, filter_width=0.0, specular_roughness=cut,
        use_final_gather=path == "LGDE",
    )  # fmt: skip


def jump(renderer, first: tuple, second: tuple) -> tuple[float, float]:
    """How much brighter the second of two sheets is than the first, as a share, and its standard error from 6 seeds."""
    ratios = []
    for seed in range(6):
        means = []
        for arguments in (first, second):
            scene = swept_sheet(*arguments)
            scene.settings.seed = seed
            means.append(renderer.render(scene).frame.combined[..., :3].mean(dtype=np.float64))
        ratios.append(means[1] / means[0] - 1)
    return float(np.mean(ratios)), float(np.std(ratios, ddof=1) / math.sqrt(6))


SWEPT = (LobeKind.GLOSSY, LobeKind.GLASS, LobeKind.REFRACTION)
WAYS = [("LGE", mode) for mode in DirectLight] + [("LDGE", DirectLight.RAYS), ("LGDE", DirectLight.PHOTONS)]
EACH_TIME = {
    ("LGE", DirectLight.RAYS, LobeKind.GLOSSY),
    ("LGE", DirectLight.PHOTONS, LobeKind.GLASS),
    ("LDGE", DirectLight.RAYS, LobeKind.REFRACTION),
    ("LGDE", DirectLight.PHOTONS, LobeKind.GLOSSY),
}
"""Each way and each kind once."""


@pytest.mark.parametrize(
    ("path", "mode", "kind"),
    some_each_time(((*way, kind) for way in WAYS for kind in SWEPT), lambda *case: case in EACH_TIME),
)
def test_no_jump_at_the_cut(renderer, path, mode, kind):
    """The same sheet on both sides of the cut: followed, and storing photons. Radii may bias by half a percent.

    In LGDE photons bring the light to the wall past a sheet that is followed; what one that stores scatters there,
    gathering rays find on it.
    """
    difference, error = jump(renderer, (path, kind, mode, 0.5, 0.51), (path, kind, mode, 0.5, 0.49))
    assert error < 0.025  # enough samples to tell
    assert abs(difference) < 4 * error + 0.005


@pytest.mark.parametrize("kind", SWEPT)
def test_photons_scatter_alike_whether_or_not_they_are_stored(renderer, kind):
    """Bit for bit, from a sheet on both sides of the cut."""
    pictures = []
    for cut in (0.49, 0.51):
        scene = swept_sheet("LGDE", kind, DirectLight.PHOTONS, 0.5, cut)
        scene.settings = scene.settings.with_values(iterations=2, photons=1024, use_final_gather=False)
        pictures.append(renderer.render(scene).frame.combined)
    assert pictures[0][..., :3].mean() > 0.01
    np.testing.assert_array_equal(*pictures)
