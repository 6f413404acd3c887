# SPDX-License-Identifier: GPL-3.0-or-later
"""Light and shadow linking: shadow rays and photons agree, and each object gets the light that is meant for it.

Against Cycles: tests/parity/features/lighting/light_linking.py.
"""

import dataclasses

import numpy as np
import pytest
import scenes
from rendering import radiance_of

from rppm_addon.scene import ALL_SETS, DirectLight, Light, LightKind, LightLinking, Scene
from rppm_addon.scene.camera import Camera

SIZE, SQUARE = 24, scenes.square("sheet", 0.8, 1.0)
OTHER = 2
"""The bit of set 1."""


def shaded_floor(mode: DirectLight, light: Light, sheet: LightLinking | None) -> Scene:
    """A floor under a sheet that shades its middle, which the camera sees from above."""
    parts = (scenes.square("floor", 3.0), scenes.diffuse(0.6, 0.6, 0.6)), (SQUARE, scenes.diffuse(0.7, 0.2, 0.1))
    scene = scenes.scene_of(
        scenes.camera((0, -5, 3), (0, 0, 0.2), 0.4, SIZE), *parts, lights=[light], photons=16384, direct_light=mode,
        camera_path_length=3, photon_path_length=4, radius_minimum=0.06, radius_maximum=0.06, seed=1, filter_width=0.0,
    )  # fmt: skip
    scene.instances[1].linking = sheet
    return scene


def lamp(casts_shadow: bool = True, **sets: int) -> Light:
    linking = LightLinking(**sets) if sets else None
    place, strength = scenes.placed(0, 0, 3), np.full(3, 10.0)
    return Light("l", LightKind.POINT, place, strength, linking=linking, casts_shadow=casts_shadow)


IN_OTHER = LightLinking(receiver_light_set=1, blocker_shadow_set=1)
NOT_OTHER = ALL_SETS & ~OTHER
CASES = {
    "plain": (lamp(), None),
    "shines on the sheet only": (lamp(light_set_membership=OTHER), IN_OTHER),
    "shines on the floor only": (lamp(light_set_membership=NOT_OTHER), IN_OTHER),
    "passes the sheet": (lamp(shadow_set_membership=NOT_OTHER), IN_OTHER),
    "neither lights nor meets it": (lamp(light_set_membership=NOT_OTHER, shadow_set_membership=NOT_OTHER), IN_OTHER),
    "casts no shadow": (lamp(casts_shadow=False), None),
}
FLOOR, SHADE, SHEET = (1.8, -1.0, 0.0), (0.0, -0.2, 0.0), (0.0, 0.0, 1.0)
"""Points in the light, in the shade of the sheet, and on it."""


def around(camera: Camera, point: tuple[float, float, float], reach: int = 1) -> tuple[slice, slice]:
    """The pixels that show a point and, so far around, what is beside it."""
    x, y, z = (np.linalg.inv(camera.matrix) @ [*point, 1.0])[:3]
    left, right, bottom, top = camera.window
    column, row = (int(SIZE * (v / -z - low) / (high - low)) for v, low, high in ((x, left, right), (y, bottom, top)))
    return slice(row - reach, row + reach + 1), slice(column - reach, column + reach + 1)


def picture(mapper, scene: Scene, iterations: int = 8) -> np.ndarray:
    return radiance_of(mapper, scene, iterations)[..., :3].astype(np.float64)


@pytest.mark.parametrize("name", CASES)
def test_shadow_rays_and_photons_agree(mapper, name):
    """At each place: of 400,000 photons that leave evenly, some 1200 come to the floor that nine pixels show, 3 %.
    Both are noisier in the shade, where all light is scattered."""
    built = [shaded_floor(mode, *CASES[name]) for mode in DirectLight]
    rays, photons = (picture(mapper, scene, 24) for scene in built)
    for point in (FLOOR, SHADE, SHEET):
        where = around(built[0].camera, point)
        np.testing.assert_allclose(photons[where].mean(), rays[where].mean(), rtol=0.15, atol=3e-4)


def test_each_object_gets_its_light(mapper):
    """Direct light alone: of that of a lamp without linking either nothing or all."""
    found = {}
    for name, (light, sheet) in CASES.items():
        scene = shaded_floor(DirectLight.RAYS, light, sheet)
        scene.settings = scene.settings.with_values(camera_path_length=1, photon_path_length=1)
        direct = picture(mapper, scene, 4)
        found[name] = [direct[around(scene.camera, point, 0)].mean() for point in (FLOOR, SHADE, SHEET)]
    floor, _, sheet = found["plain"]
    below = found["casts no shadow"][1]
    assert min(floor, sheet) > 0.02 and below > floor
    expected = {
        "plain": [floor, 0.0, sheet],
        "shines on the sheet only": [0.0, 0.0, sheet],
        "shines on the floor only": [floor, 0.0, 0.0],
        "passes the sheet": [floor, below, sheet],
        "neither lights nor meets it": [floor, below, 0.0],
        "casts no shadow": [floor, below, sheet],
    }
    for name, values in expected.items():
        np.testing.assert_allclose(found[name], values, rtol=1e-3, atol=1e-6, err_msg=name)


@pytest.mark.parametrize("mode", DirectLight)
def test_light_without_bounces_is_direct_light(mapper, mode):
    """The same random numbers, so the same picture as of paths that end where the light comes first."""
    scene = shaded_floor(mode, lamp(), None)
    scene.settings = scene.settings.with_values(use_final_gather=False)
    scene.lights = [dataclasses.replace(scene.lights[0], max_bounces=0)]
    limited = picture(mapper, scene, 2)
    scene.lights = [lamp()]
    scattered = picture(mapper, scene, 2)
    scene.settings = scene.settings.with_values(camera_path_length=1, photon_path_length=1)
    direct = picture(mapper, scene, 2)
    np.testing.assert_allclose(limited, direct, rtol=1e-5, atol=1e-7)
    assert scattered.mean() > 1.005 * direct.mean()


@pytest.mark.parametrize(("name", "alpha"), {"plain": 1.0, "passes the sheet": 0.0, "casts no shadow": 0.0}.items())
def test_shadow_catchers_ask_who_casts_shadows(mapper, name, alpha):
    scene = shaded_floor(DirectLight.RAYS, *CASES[name])
    scene.settings = scene.settings.with_values(film_transparent=True)
    scene.instances[0].shadow_catcher = True
    picture(mapper, scene, 2)
    found = mapper.film.read_radiance()[..., 3][around(scene.camera, SHADE, 0)]
    np.testing.assert_allclose(found, alpha, atol=1e-5)
