# SPDX-License-Identifier: GPL-3.0-or-later
"""The photons' flux: what is emitted is absorbed on the way, deposited at its end, or escapes."""

import math

import pytest

from ..engines import exported_scene
from ..scenes import DIFFUSE, EMISSION, GLASS, PRINCIPLED, ball, box, camera, light, material, new_scene, place, plane


def _open_floor():
    plane(1.0, material(DIFFUSE, Color=0.8))
    light("POINT", 80.0, place(at=(0.2, 0.1, 0.7)), shadow_soft_size=0.1, use_soft_falloff=False)
    return 80.0


def _closed_box():
    box((1.0, 1.0, 1.0), material(DIFFUSE, Color=(0.7, 0.5, 0.3)))
    light("AREA", 30.0, place(at=(0.0, 0.0, 0.9)), shape="SQUARE", size=0.5)
    return 30.0


def _glass_and_metal():
    plane(2.0, material(PRINCIPLED, Base_Color=(0.2, 0.5, 0.8), Roughness=0.4))
    ball(0.4, material(GLASS, Color=(0.9, 0.9, 1.0), Roughness=0.1, IOR=1.5), place(at=(-0.5, 0.0, 0.5)))
    ball(0.4, material(PRINCIPLED, Base_Color=(0.9, 0.6, 0.3), Metallic=1.0, Roughness=0.6), place(at=(0.5, 0.0, 0.5)))
    light("AREA", 60.0, place(at=(0.0, 0.0, 2.5)), shape="DISK", size=1.0, color=(1.0, 0.5, 0.25))
    return 60.0 * (1.0 + 0.5 + 0.25) / 3.0


def _glowing_quad():
    plane(2.0, material(DIFFUSE, Color=0.5))
    plane(0.5, material(EMISSION, Color=1.0, Strength=4.0), place(at=(0.0, 0.0, 1.0)))
    return 2 * math.pi * 4.0  # both sides of a square meter


@pytest.mark.parametrize("build", [_open_floor, _closed_box, _glass_and_metal, _glowing_quad])
@pytest.mark.parametrize("photon_path_length", [2, 12])
def test_flux_balances(renderer, build, photon_path_length):
    new_scene()
    power = build()
    camera((0.0, -0.9, 0.5), (0.0, 0.0, 0.4), 60.0)
    scene = exported_scene()
    settings = {"photons": 65536, "iterations": 2, "photon_path_length": photon_path_length}
    scene.settings = scene.settings.with_values(seed=0, **settings)
    flux = renderer.render(scene).statistics.flux_watts
    balance = (flux["absorbed"] + flux["deposited"] + flux["escaped"]) / flux["emitted"]
    print(f"\n{build.__name__}, {photon_path_length} segments: {flux}, balance {balance:.7f}")
    assert abs(balance - 1.0) <= 1e-4
    # The lights' powers are averages over the channels; fluxes are sums over the three.
    assert flux["emitted"] / 3.0 == pytest.approx(power, rel=2e-3)
    if build is _closed_box:
        assert flux["escaped"] <= 1e-4 * flux["emitted"]
