# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes whose radiance is known in closed form."""

import bpy
import numpy as np
import pytest

from ..comparison import CONVERGED, compare
from ..engines import render_rppm
from ..net import material as empty_material
from ..scenes import DIFFUSE, GLASS, GLOSSY, PRINCIPLED, ball, box, camera, light, material, new_scene, place, plane


def glowing_diffuse(albedo: float, radiance: float) -> bpy.types.Material:
    """Diffuse that emits as well, through Add Shader."""
    made, net = empty_material("Material")
    reflecting = net.out("BsdfDiffuse", 0, {"Color": albedo})
    net.output(net.out("AddShader", 0, {0: reflecting, 1: net.emission(1.0, radiance)}))
    return made


def assert_radiance(renderer, name: str, radiance: float, **settings: object) -> None:
    """Everywhere in the picture."""
    pictures = render_rppm(renderer, **settings)
    compare(name, pictures, np.full_like(pictures[:1], radiance), CONVERGED)


@pytest.mark.parametrize(
    ("shape", "mode"),
    [("box", "RAYS"), ("box", "PHOTONS"), ("ball", "RAYS"), pytest.param("ball", "PHOTONS", marks=pytest.mark.long)],
)
def test_furnace(renderer, shape, mode):
    """Inside a closed surface that emits 1 and reflects a half, radiance is 1 / (1 - 0.5) everywhere."""
    new_scene()
    glowing = glowing_diffuse(albedo=0.5, radiance=1.0)
    if shape == "box":
        box((1.0, 1.0, 1.0), glowing)
    else:
        ball(1.0, glowing, segments=48)
    camera((0.5, 0.3, 0.2), (-1.0, -0.4, -0.1), 80.0)
    settings = {"direct_light": mode, "photons": 32768, "photon_path_length": 11, "iterations": 4}
    assert_radiance(renderer, f"furnace_{shape}_{mode.lower()}", 2.0, **settings)


@pytest.mark.parametrize("mode", ["RAYS", "PHOTONS"])
def test_diffuse_plane_under_a_white_sky(renderer, mode):
    new_scene(world=1.0)
    plane(3.0, material(DIFFUSE, Color=0.6))
    camera((0.0, -1.0, 6.0), (0.0, 0.0, 0.0), 30.0)
    settings = {"direct_light": mode, "photons": 32768, "photon_path_length": 2, "iterations": 12}
    assert_radiance(renderer, f"sky_{mode.lower()}", 0.6, **settings)


@pytest.mark.parametrize("roughness", [0.0, 0.3, 0.6])
def test_white_glass_vanishes_in_a_white_sky(renderer, roughness):
    """White glass that loses no energy cannot be seen where all light has radiance 1."""
    new_scene(world=1.0)
    ball(1.0, material(GLASS, Color=1.0, Roughness=roughness, IOR=1.5))
    camera((0.0, -4.0, 0.0), (0.0, 0.0, 0.0), 30.0)
    settings = {"photons": 1024, "photon_path_length": 1, "iterations": 12, "camera_path_length": 32}
    assert_radiance(renderer, f"white_glass_{roughness}", 1.0, specular_roughness=1.0, **settings)


def test_white_glass_that_stores_photons_vanishes_in_a_white_sky(renderer):
    """Paths that are joined within the glass lose and gain no energy either."""
    new_scene(resolution=32, world=1.0)
    ball(1.0, material(GLASS, "MULTI_GGX", Color=1.0, Roughness=0.6, IOR=1.5), segments=48)
    camera((0.0, -4.0, 0.0), (0.0, 0.0, 0.0), 18.0)
    settings = {"specular_roughness": 0.0, "use_final_gather": False, "camera_path_length": 2, "photon_path_length": 24}
    # Many seeds: of three, chance alone made the error twice what it is.
    pictures = render_rppm(renderer, seeds=12, photons=16384, iterations=3, **settings)
    means = pictures.mean(axis=(1, 2, 3))
    error = means.std(ddof=1) / np.sqrt(len(means))
    print(f"\n{means.mean():.4f} +- {error:.4f}")
    assert error < 0.025
    assert abs(means.mean() - 1.0) < 4.0 * error


@pytest.mark.parametrize("shader", [GLOSSY, PRINCIPLED])
def test_white_metal_vanishes_in_a_white_sky(renderer, shader):
    new_scene(world=1.0)
    inputs = {"Color": 1.0} if shader == GLOSSY else {"Base_Color": 1.0, "Metallic": 1.0}
    distribution = "MULTI_GGX" if shader == GLOSSY else None
    ball(1.0, material(shader, distribution, Roughness=0.7, **inputs))
    camera((0.0, -4.0, 0.0), (0.0, 0.0, 0.0), 30.0)
    settings = {"photons": 1024, "photon_path_length": 2, "iterations": 12, "specular_roughness": 1.0}
    assert_radiance(renderer, f"white_metal_{shader}", 1.0, **settings)


def test_radiance_is_not_scaled_inside_glass(renderer):
    """A lit plane seen through a flat pane of index 1.5: (1 - F) squared plus the inner reflections, 12 / 13 of it."""
    new_scene()
    plane(8.0, glowing_diffuse(albedo=0.0, radiance=3.0))
    box((2.0, 2.0, 0.1), material(GLASS, Color=1.0, Roughness=0.0, IOR=1.5), place(at=(0.0, 0.0, 1.0)))
    camera((0.0, 0.0, 6.0), (0.0, 0.0, 0.0), 4.0)
    reflectivity = 0.04
    through = (1 - reflectivity) / (1 + reflectivity)
    settings = {"photons": 1024, "photon_path_length": 1, "iterations": 24, "camera_path_length": 12}
    assert_radiance(renderer, "pane", 3.0 * through, **settings)


def test_nothing_but_the_light_is_lit_behind_it(renderer):
    """An area light sends nothing backwards."""
    new_scene()
    plane(3.0, material(DIFFUSE, Color=0.8))
    light("AREA", 100.0, place(at=(0.0, 0.0, 1.0), turn=(180.0, 0.0, 0.0)), size=1.0)
    camera((0.0, -1.0, 6.0), (0.0, 0.0, 0.0), 30.0)
    for mode in ("RAYS", "PHOTONS"):
        pictures = render_rppm(renderer, seeds=1, direct_light=mode, photons=8192, iterations=4)
        assert pictures.max() == 0.0, mode
