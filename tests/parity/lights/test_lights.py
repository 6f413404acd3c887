# SPDX-License-Identifier: GPL-3.0-or-later
"""Each light on a diffuse plane, direct light by rays and by photons, against Cycles."""

import itertools
import math

import pytest
from support.families import some_each_time

from ..engines import compare_with_cycles
from ..net import Net
from ..scenes import DIFFUSE, EMISSION, box, camera, light, material, new_scene, place, plane

UP_TWO = {"at": (0.3, 0.2, 2.0)}
TILTED = {"at": (0.5, 0.0, 2.0), "turn": (20.0, 30.0, 10.0)}


def _light(kind, where, energy=100.0, **properties):
    return lambda: light(kind, energy, place(**where), **properties)


def _glowing_square():
    glow = material(EMISSION, Color=(1.0, 0.6, 0.3), Strength=20.0)
    plane(0.4, glow, place(at=(0.5, 0.0, 2.0), turn=(80.0, 0.0, 30.0)))


def _square_seen_by_no_ray():
    """Its nodes let it shine except along rays of any kind: where a light is sampled, there is none yet."""
    glow = material(EMISSION, Color=(1.0, 0.6, 0.3), Strength=20.0)
    net = Net(glow.node_tree)
    inputs = {0: net.out("LightPath", "Is Reflection Ray"), 1: -20.0, 2: 20.0}
    net.set(net.find("EMISSION").inputs["Strength"], net.out("Math", 0, inputs, operation="MULTIPLY_ADD"))
    glow.cycles.emission_sampling = "FRONT_BACK"
    plane(0.4, glow, place(**TILTED))


FACTORS = {
    "normalize": False, "exposure": 1.5, "color": (1.0, 0.7, 0.5), "use_temperature": True, "temperature": 4000.0,
}  # fmt: skip
LIGHTS = {
    "point": _light("POINT", UP_TWO, shadow_soft_size=0.0),
    "point_soft": _light("POINT", UP_TWO, shadow_soft_size=0.5),
    "point_sphere": _light("POINT", UP_TWO, shadow_soft_size=0.5, use_soft_falloff=False),
    "point_factors": _light("POINT", UP_TWO, energy=3.0, shadow_soft_size=0.4, **FACTORS),
    "spot": _light("SPOT", TILTED, shadow_soft_size=0.0, spot_size=math.radians(70.0), spot_blend=0.5),
    "spot_scaled": _light(
        "SPOT", TILTED | {"scale": (1.0, 1.6, 1.0)}, shadow_soft_size=0.2, spot_size=math.radians(50.0), spot_blend=0.8
    ),
    "sun": _light("SUN", TILTED, energy=3.0, angle=0.0),
    "sun_wide": _light("SUN", TILTED, energy=3.0, angle=math.radians(40.0)),
    "area_square": _light("AREA", UP_TWO, shape="SQUARE", size=1.0),
    "area_rectangle": _light("AREA", TILTED | {"scale": (2.0, 0.5, 1.0)}, shape="RECTANGLE", size=0.6, size_y=1.4),
    "area_disk": _light("AREA", UP_TWO, shape="DISK", size=1.0),
    "area_ellipse": _light("AREA", TILTED | {"scale": (2.0, 1.0, 3.0)}, shape="ELLIPSE", size=0.5, size_y=0.3),
    "area_spread": _light("AREA", TILTED, shape="SQUARE", size=0.7, spread=math.radians(100.0)),
    "area_not_normalized": _light("AREA", UP_TWO, energy=10.0, shape="DISK", size=1.5, normalize=False),
    "emissive_mesh": _glowing_square,
    "emissive_mesh_of_no_ray": _square_seen_by_no_ray,
}
MODES = {
    "RAYS": {"photons": 1024, "photon_path_length": 2, "iterations": 12},
    "PHOTONS": {"photons": 32768, "photon_path_length": 2, "iterations": 6},
}


PHOTONS_EACH_TIME = ("point", "spot", "sun", "area_square", "emissive_mesh")
"""A light of each kind; with rays all are tried each time."""


@pytest.mark.parametrize(
    ("name", "mode"),
    some_each_time(itertools.product(LIGHTS, MODES), lambda name, mode: mode == "RAYS" or name in PHOTONS_EACH_TIME),
)
def test_light_on_a_diffuse_plane(renderer, name, mode):
    new_scene()
    plane(3.0, material(DIFFUSE, Color=(0.8, 0.7, 0.6)))
    camera((0.0, -1.0, 6.0), (0.0, 0.0, 0.0), 30.0)
    LIGHTS[name]()
    compare_with_cycles(renderer, f"light_{name}_{mode.lower()}", 256, direct_light=mode, **MODES[mode])


CUT_LAMPS = {
    "disk": _light("POINT", {}, shadow_soft_size=0.3),
    "sphere": _light("POINT", {}, shadow_soft_size=0.3, use_soft_falloff=False),
}


@pytest.mark.parametrize("mode", ["RAYS", pytest.param("PHOTONS", marks=pytest.mark.long)])
@pytest.mark.parametrize("name", CUT_LAMPS)
def test_lamp_half_in_a_floor(renderer, name, mode):
    """Light that the walls get of it, and that comes from the floor within its radius, in a closed room."""
    new_scene()
    gray = material(DIFFUSE, Color=0.5)
    box((2.0, 2.0, 2.0), gray)
    plane(2.0, gray)
    camera((0.0, -1.8, 1.0), (0.0, 2.0, 0.8), 90.0)
    CUT_LAMPS[name]()
    settings = {"direct_light": mode, "photons": 32768, "iterations": 12}
    compare_with_cycles(renderer, f"lamp_in_a_floor_{name}_{mode.lower()}", 256, **settings)
