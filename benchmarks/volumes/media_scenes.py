# SPDX-License-Identifier: GPL-3.0-or-later
"""Small Blender scenes of plain media, which beside_cycles.py renders in both engines."""

from collections.abc import Callable

import bpy

from tests.parity.media.scenes import fog_in_a_cube, medium, scatter, spot_in_the_worlds_fog
from tests.parity.net import Net, diffuse
from tests.parity.net import material as net_material
from tests.parity.scenes import GLASS, ball, box, camera, light, new_scene, place, plane
from tests.parity.scenes import material as shader_material

BALL = 1.0
"""Radius of balls, meters."""


def _begin(world: float, volume_bounces: int) -> None:
    scene = new_scene(world=world)
    scene.cycles.volume_bounces, scene.cycles.max_bounces = volume_bounces, 32
    scene.cycles.caustics_reflective = scene.cycles.caustics_refractive = True


def _floor_below_a_ball() -> None:
    plane(6.0, diffuse("Floor", (0.6, 0.55, 0.5)), place(at=(0.0, 0.0, -1.1)))
    camera((0.0, -5.0, 1.2), (0.0, 0.0, -0.1), 40.0)


def dense_ball() -> None:
    """A ball as deep as 18 mean free paths, under a sun and an even sky."""
    _begin(0.4, 30)
    _floor_below_a_ball()
    ball(BALL, medium("Cloud", scatter(9.0, (0.98, 0.97, 0.95))))
    light("SUN", 3.0, place(turn=(40.0, 0.0, 30.0))).data.angle = 0.01


def cloud() -> None:
    """A ball with a density of noise, under a sun and an area light."""
    _begin(0.0, 12)
    _floor_below_a_ball()
    made, net = net_material("Cloud")
    noise = net.out("TexNoise", inputs={"Vector": net.out("TexCoord", "Object"), "Scale": 2.5, "Detail": 3.0})
    density = net.out("MapRange", inputs={"Value": noise, "From Min": 0.45, "From Max": 0.65, "To Max": 8.0})
    net.output(Volume=net.out("VolumeScatter", inputs={"Color": 0.98, "Density": density, "Anisotropy": 0.3}))
    ball(BALL, made)
    light("SUN", 3.0, place(turn=(40.0, 0.0, 30.0))).data.angle = 0.01
    light("AREA", 200.0, place(at=(-3.0, -1.0, 2.0), turn=(0.0, -60.0, 0.0)), shape="SQUARE", size=1.0)


def world_haze() -> None:
    """Thin fog in the whole world, with a lamp and an area light."""
    _begin(0.0, 4)
    _floor_below_a_ball()
    ball(0.6, diffuse("Ball", (0.7, 0.3, 0.2)), place(at=(0.0, 0.0, -0.5)))
    net = Net(bpy.context.scene.world.node_tree)
    net.tree.links.new(scatter(0.05, (0.8, 0.9, 1.0))(net), net.find("OUTPUT_WORLD").inputs["Volume"])
    light("POINT", 200.0, place(at=(1.5, -0.5, 1.0)), shadow_soft_size=0.1)
    light("AREA", 200.0, place(at=(-2.0, 0.0, 3.0)), shape="SQUARE", size=1.0)


def fog_cube() -> None:
    """A cube of fog with a point light above and one within."""
    _begin(0.0, 8)
    fog_in_a_cube()


def spot_in_fog() -> None:
    """A spot light from the side, in fog that fills the world."""
    _begin(0.0, 4)
    spot_in_the_worlds_fog()


def glass_ball_in_fog() -> None:
    """A ball of glass in a box of fog, with a small area light above."""
    _begin(0.1, 4)
    _floor_below_a_ball()
    ball(0.5, shader_material(GLASS, Color=1.0, Roughness=0.0, IOR=1.5), place(at=(0.0, 0.0, -0.3)), segments=64)
    box((3.0, 3.0, 2.5), medium("Fog", scatter(0.15, (0.9, 0.9, 0.9))), place(at=(0.0, 0.0, 1.5)))
    light("AREA", 150.0, place(at=(0.5, 0.0, 2.5)), shape="SQUARE", size=0.5)


def milk() -> None:
    """Milk that overlaps its glass, around a core, under an area light and a sky."""
    _begin(0.3, 30)
    _floor_below_a_ball()
    made, net = net_material("Milk")
    coefficients = {"Scatter Coefficients": (3.0, 2.8, 2.5), "Absorption Coefficients": (0.02, 0.05, 0.2)}
    volume = net.out("VolumeCoefficients", inputs=coefficients)
    net.output(net.out("BsdfGlass", inputs={"Color": 1.0, "Roughness": 0.0, "IOR": 1.3}), Volume=volume)
    ball(0.94 * BALL, made, segments=96)
    clear = shader_material(GLASS, Color=1.0, Roughness=0.0, IOR=1.5)
    ball(BALL, clear, segments=96)
    ball(0.9 * BALL, clear, segments=96).data.flip_normals()
    ball(0.4, diffuse("Core", (0.8, 0.1, 0.1)))
    light("AREA", 150.0, place(at=(0.0, 0.0, 2.5)), shape="SQUARE", size=4.0)


def _room_for_a_glow(made: bpy.types.Material) -> None:
    plane(3.0, diffuse("Floor", (0.8, 0.7, 0.6)), place(at=(0.0, 0.0, -1.2)))
    plane(3.0, diffuse("Wall", (0.5, 0.6, 0.8)), place(at=(0.0, 1.8, 0.0), turn=(90.0, 0.0, 0.0)))
    ball(0.4, diffuse("Ball", (0.7, 0.7, 0.7)), place(at=(1.3, -0.4, -0.8)), segments=32)
    camera((0.0, -6.0, 1.2), (0.0, 0.0, -0.1), 40.0)
    box((0.5, 0.5, 0.7), made, place(at=(-0.3, 0.2, 0.0), turn=(0.0, 0.0, 25.0)))


def glow_principled() -> None:
    """A box of a Principled Volume that scatters and shines."""
    _begin(0.0, 4)
    made, net = net_material("Glow")
    given = {"Color": (0.8, 0.7, 0.6), "Density": 1.0, "Emission Strength": 1.5, "Emission Color": (1.0, 0.5, 0.2)}
    net.output(Volume=net.out("VolumePrincipled", inputs=given))
    _room_for_a_glow(made)


def glow_of_a_blackbody() -> None:
    """A box of a Principled Volume that shines as a blackbody whose temperature varies, and scatters."""
    _begin(0.0, 4)
    made, net = net_material("Fire")
    height = net.out("SeparateXYZ", "Z", inputs={"Vector": net.out("TexCoord", "Object")})
    heat = {"Value": height, "From Min": -0.7, "From Max": 0.7, "To Min": 1800.0, "To Max": 1000.0}
    temperature = net.out("MapRange", inputs=heat)
    given = {"Color": 0.5, "Density": 0.5, "Blackbody Intensity": 1.0, "Temperature": temperature}
    net.output(Volume=net.out("VolumePrincipled", inputs=given))
    _room_for_a_glow(made)


def glow_of_emission() -> None:
    """A box with an Emission linked to Volume."""
    _begin(0.0, 4)
    made, net = net_material("Glow")
    net.output(Volume=net.emission((1.0, 0.5, 0.2), 1.0))
    _room_for_a_glow(made)


def glow_in_smoke() -> None:
    """A box of dense smoke with a noise of flames in it."""
    _begin(0.0, 8)
    made, net = net_material("Smoke")
    noise = net.out("TexNoise", inputs={"Vector": net.out("TexCoord", "Object"), "Scale": 2.0, "Detail": 2.0})
    flame = net.out("MapRange", inputs={"Value": noise, "From Min": 0.55, "From Max": 0.7, "To Max": 20.0})
    given = {"Color": 0.6, "Density": 4.0, "Emission Strength": flame, "Emission Color": (1.0, 0.5, 0.2)}
    net.output(Volume=net.out("VolumePrincipled", inputs=given))
    _room_for_a_glow(made)


SCENES: dict[str, Callable[[], None]] = {
    scene.__name__: scene
    for scene in (
        dense_ball, cloud, world_haze, fog_cube, spot_in_fog, glass_ball_in_fog, milk,
        glow_principled, glow_of_a_blackbody, glow_of_emission, glow_in_smoke,
    )
}  # fmt: skip
"""Functions that make them, by name."""
