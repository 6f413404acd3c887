# SPDX-License-Identifier: GPL-3.0-or-later
"""Light that comes through transparent surfaces, by shadow rays to lobes of any roughness, against Cycles."""

import bpy
import numpy as np
import pytest

from ..comparison import Tolerance
from ..engines import compare_with_cycles
from ..net import Net
from ..scenes import DIFFUSE, EMISSION, PRINCIPLED, background, box, camera, light, material, new_scene, place, plane

NEAR = Tolerance(mean=0.01, block=0.03, mode=0.01)
CLEAR = "ShaderNodeBsdfTransparent"


def floor(metallic: float, roughness: float) -> None:
    plane(2.5, material(PRINCIPLED, Base_Color=0.8, Metallic=metallic, Roughness=roughness))


def metal_below_alpha() -> None:
    floor(1.0, 0.4)
    plane(2.5, material(PRINCIPLED, Base_Color=0.8, Metallic=1.0, Roughness=0.4, Alpha=0.5), place(at=(0.0, 0.0, 1.5)))
    light("POINT", 600.0, place(at=(0.0, 3.0, 4.0)), shadow_soft_size=0.3)


def smooth_metal_below_two_panes() -> None:
    floor(1.0, 0.15)
    plane(2.5, material(CLEAR, Color=(0.8, 0.5, 0.2)), place(at=(0.0, 0.0, 1.5)))
    plane(2.5, material(CLEAR, Color=(0.9, 0.9, 0.5)), place(at=(0.0, 0.0, 1.8)))
    light("AREA", 300.0, place(at=(0.0, 3.0, 4.0), turn=(-40.0, 0.0, 0.0)), shape="SQUARE", size=2.0)


def diffuse_below_a_card_in_the_sun() -> None:
    floor(0.0, 0.5)
    plane(0.7, material(PRINCIPLED, Base_Color=0.8, Alpha=0.5), place(at=(0.0, 0.0, 1.0)))
    plane(0.4, material(CLEAR, Color=(0.9, 0.5, 0.2)), place(at=(0.5, 0.2, 0.6)))
    light("SUN", 3.0, place(turn=(20.0, 30.0, 0.0)), angle=0.02)
    background().inputs["Strength"].default_value = 0.3


def a_panel_that_shines_through_a_pane() -> None:
    floor(0.0, 0.3)
    plane(1.5, material(CLEAR, Color=(0.9, 0.5, 0.2)), place(at=(0.0, 0.0, 0.5)))
    plane(0.5, material(EMISSION, Color=1.0, Strength=20.0), place(at=(0.0, 0.0, 2.0)))


def card_for_cameras_alone() -> None:
    """Diffuse, but where a shadow ray asks."""
    hidden_card()
    light("SUN", 3.0, place(turn=(10.0, 0.0, 0.0)), angle=0.02)


def card_for_cameras_alone_below_a_lamp() -> None:
    hidden_card()
    light("POINT", 300.0, place(at=(0.0, 0.5, 3.0)), shadow_soft_size=0.2)


def card_for_cameras_alone_in_a_smooth_floor() -> None:
    """The floor's reflection shows the card before the lamp, though shadow rays find the lamp through the card."""
    hidden_card(0.0)
    light("AREA", 100.0, place(at=(0.0, 3.25, 2.6), turn=(-50.0, 0.0, 0.0)), shape="SQUARE", size=1.0)


def hidden_card(floor_roughness: float = 0.5) -> None:
    floor(0.0, floor_roughness)
    made = material(DIFFUSE, Color=0.8)
    net = Net(made.node_tree)
    mix, path, clear = net.node("MixShader"), net.node("LightPath"), net.node("BsdfTransparent")
    sources = path.outputs["Is Shadow Ray"], net.find("BSDF_DIFFUSE").outputs[0], clear.outputs[0]
    for source, end in zip(sources, mix.inputs, strict=True):
        net.set(end, source)
    net.set(net.find("OUTPUT_MATERIAL").inputs["Surface"], mix.outputs[0])
    plane(1.2, made, place(at=(0.0, 0.5, 0.9)))


@pytest.mark.parametrize(
    "build",
    [
        metal_below_alpha,
        smooth_metal_below_two_panes,
        diffuse_below_a_card_in_the_sun,
        a_panel_that_shines_through_a_pane,
        card_for_cameras_alone,
        card_for_cameras_alone_below_a_lamp,
        card_for_cameras_alone_in_a_smooth_floor,
    ],
)
def test_light_through_transparent_surfaces(renderer, build):
    new_scene(32)
    build()
    camera((0.0, -5.0, 2.5), (0.0, 0.0, 0.2), 38.0)
    compare_with_cycles(renderer, f"transparent_{build.__name__}", 1024, NEAR, seeds=2, iterations=96, photons=512)


@pytest.mark.long
def test_photons_pass_what_shadow_rays_pass_in_a_room(renderer):
    new_scene(32)
    box((2.0, 2.0, 2.0), material(DIFFUSE, Color=0.6), place(at=(0.0, 0.0, 1.5)))
    card_for_cameras_alone()
    bpy.data.objects.remove(next(thing for thing in bpy.data.objects if thing.type == "LIGHT"))
    light("POINT", 60.0, place(at=(0.0, 0.3, 2.6)), shadow_soft_size=0.3)
    camera((0.0, -1.9, 0.7), (0.0, 0.0, 0.6), 70.0)
    settings = {"iterations": 64, "photons": 8192, "photon_path_length": 24, "camera_path_length": 16}
    pictures, _ = compare_with_cycles(renderer, "transparent_card_in_a_room", 512, NEAR, seeds=2, **settings)
    assert np.isfinite(pictures).all()
