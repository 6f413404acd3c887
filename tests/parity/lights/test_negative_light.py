# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces, lights and worlds that take light away, as in Cycles."""

import bpy
import numpy as np
import pytest

from ..comparison import Tolerance
from ..engines import compare_with_cycles, render_rppm
from ..net import Net
from ..scenes import DIFFUSE, EMISSION, PRINCIPLED, background, box, camera, light, material, new_scene, place, plane

COLOR = (-0.4, 0.2, 0.9)
NEAR = Tolerance(mean=0.01, block=0.03, mode=0.01)


def shining(shader: str, color: tuple[float, float, float]) -> bpy.types.Material:
    """Emission by a node, since sockets of colors hold no negative ones."""
    made = material(shader, **({"Base_Color": 0.0, "Emission_Strength": 1.0} if shader == PRINCIPLED else {}))
    net = Net(made.node_tree)
    kind, name = ("EMISSION", "Color") if shader == EMISSION else ("BSDF_PRINCIPLED", "Emission Color")
    net.set(net.find(kind).inputs[name], net.out("CombineXYZ", 0, dict(enumerate(color))))
    return made


@pytest.mark.parametrize("shader", [EMISSION, PRINCIPLED])
def test_the_camera_sees_negative_emission_as_it_is(renderer, shader):
    new_scene(8)
    plane(2.0, shining(shader, COLOR))
    camera((0.0, 0.0, 3.0), (0.0, 0.0, 0.0), 20.0)
    seen = render_rppm(renderer, seeds=1, iterations=1)
    np.testing.assert_allclose(seen, np.broadcast_to(COLOR, seen.shape), atol=1e-6)


def test_the_camera_sees_a_negative_world_as_it_is(renderer):
    new_scene(8, world=-0.5)
    camera((0.0, 0.0, 3.0), (0.0, 0.0, 0.0), 20.0)
    assert (render_rppm(renderer, seeds=1, iterations=1) == -0.5).all()


def by_surface() -> None:
    light("SUN", 1.0, place())
    plane(1.0, shining(EMISSION, COLOR), place(at=(1.5, 0.0, 0.5), turn=(0.0, 90.0, 0.0)))


def by_lamps() -> None:
    light("SUN", 3.0, place())
    light("POINT", -30.0, place(at=(0.0, 0.0, 1.2)), shadow_soft_size=0.2)
    light("AREA", -10.0, place(at=(1.0, 0.0, 1.2)), shape="SQUARE", size=0.5)


def by_nodes_of_a_lamp() -> None:
    light("SUN", 3.0, place())
    made = light("POINT", 30.0, place(at=(0.0, 0.0, 1.2)), shadow_soft_size=0.2)
    made.data.use_nodes = True
    Net(made.data.node_tree).find("EMISSION").inputs["Strength"].default_value = -1.0


def by_an_even_world() -> None:
    light("SUN", 3.0, place())
    background().inputs["Strength"].default_value = -0.5


def by_a_world_of_both_signs() -> None:
    """Its directions are its color: of a red and green that is as often negative as not, nothing is left."""
    light("SUN", 1.0, place())
    background().inputs["Strength"].default_value = 1.0
    net = Net(bpy.context.scene.world.node_tree)
    net.set(background().inputs["Color"], net.out("TexCoord", "Generated"))


@pytest.mark.parametrize("take", [by_surface, by_lamps, by_nodes_of_a_lamp, by_an_even_world, by_a_world_of_both_signs])
def test_negative_light(renderer, take):
    new_scene(32)
    plane(3.0, material(DIFFUSE, Color=0.8))
    camera((0.0, 0.0, 3.0), (0.0, 0.0, 0.0), 20.0)
    take()
    compare_with_cycles(renderer, f"negative_{take.__name__}", 512, NEAR, seeds=2, iterations=96, photons=256)


@pytest.mark.long
def test_photons_take_light_away_in_a_room(renderer):
    new_scene(32)
    box((2.0, 2.0, 2.0), material(DIFFUSE, Color=0.7))
    camera((0.0, -1.9, 0.0), (0.0, 0.0, -0.3), 60.0)
    light("POINT", 100.0, place(at=(0.0, 0.0, 1.0)), shadow_soft_size=0.2)
    light("SPOT", -60.0, place(at=(0.8, 0.0, 1.0)), shadow_soft_size=0.1, spot_size=1.2)
    settings = {"seeds": 2, "iterations": 64, "photons": 8192, "photon_path_length": 24}
    compare_with_cycles(renderer, "negative_room", 512, NEAR, **settings)
