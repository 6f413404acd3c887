# SPDX-License-Identifier: GPL-3.0-or-later
"""Small scenes of media that scatter, the same for both engines."""

from collections.abc import Callable

import bpy

from ..net import Net, diffuse, material
from ..scenes import GLASS, ball, box, camera, light, new_scene, place, plane
from ..scenes import material as shader_material

Volume = Callable[[Net], bpy.types.NodeSocket]
PHASES = {
    "HENYEY_GREENSTEIN": {"Anisotropy": 0.6},
    "FOURNIER_FORAND": {"IOR": 1.33, "Backscatter": 0.1},
    "DRAINE": {"Anisotropy": 0.4, "Alpha": 3.0},
    "RAYLEIGH": {},
    "MIE": {"Diameter": 3.0},
}
"""Inputs of Volume Scatter by phase function."""


def scatter(density: float, color: tuple | float = 1.0, phase: str = "HENYEY_GREENSTEIN", **inputs: float) -> Volume:
    """A Volume Scatter; inputs by their names."""
    return lambda net: net.out("VolumeScatter", inputs={"Color": color, "Density": density, **inputs}, phase=phase)


def added(*parts: Volume) -> Volume:
    """The sum of volumes."""

    def make(net: Net) -> bpy.types.NodeSocket:
        total = parts[0](net)
        for part in parts[1:]:
            total = net.out("AddShader", inputs={0: total, 1: part(net)})
        return total

    return make


def medium(name: str, volume: Volume) -> bpy.types.Material:
    """A material that has a volume alone."""
    made, net = material(name)
    net.output(Volume=volume(net))
    return made


def begin(volume_bounces: int) -> bpy.types.Scene:
    """A black scene with a limit of bounces in volumes."""
    scene = new_scene()
    scene.cycles.volume_bounces = volume_bounces
    return scene


def _floor_and_camera() -> None:
    plane(4.0, diffuse("Floor", (0.6, 0.55, 0.5)))
    camera((0.0, -6.0, 2.6), (0.0, 0.0, 0.8), 38.0)


def fog_in_a_cube() -> None:
    """A cube of fog over a floor, with a point light above and one within."""
    _floor_and_camera()
    fog = medium("Fog", scatter(1.2, (0.9, 0.7, 0.4), Anisotropy=0.4))
    box((1.0, 1.0, 0.8), fog, place(at=(0.0, 0.0, 1.0)))
    light("POINT", 200.0, place(at=(1.5, -0.5, 3.0)), shadow_soft_size=0.1)
    light("POINT", 30.0, place(at=(-0.4, 0.2, 1.0)), shadow_soft_size=0.1)


def spot_in_the_worlds_fog() -> None:
    """A spot light from the side, in fog that fills the world, onto a wall."""
    _floor_and_camera()
    net = Net(bpy.context.scene.world.node_tree)
    net.tree.links.new(scatter(0.12, (0.8, 0.9, 1.0), Anisotropy=0.5)(net), net.find("OUTPUT_WORLD").inputs["Volume"])
    plane(2.0, diffuse("Wall", (0.4, 0.6, 0.7)), place(at=(2.2, 0.0, 1.5), turn=(0.0, -90.0, 0.0)))
    light("SPOT", 600.0, place(at=(-2.5, 0.0, 1.5), turn=(0.0, -90.0, 0.0)), spot_size=0.5, shadow_soft_size=0.05)


def overlapping_volumes() -> None:
    """Two boxes that share a part, of other phase functions and colors; one absorbs and shines as well."""
    _floor_and_camera()
    left = added(
        scatter(0.8, (1.0, 0.5, 0.3), Anisotropy=-0.4),
        lambda net: net.out("VolumeAbsorption", inputs={"Color": (0.3, 0.6, 0.9), "Density": 0.5}),
        lambda net: net.emission((0.2, 0.5, 1.0), 0.08),
    )
    box((0.8, 0.8, 0.8), medium("Left", left), place(at=(-0.5, 0.0, 1.0)))
    right = scatter(1.0, (0.4, 0.8, 1.0), phase="RAYLEIGH")
    box((0.8, 0.7, 0.6), medium("Right", right), place(at=(0.5, 0.1, 1.1)))
    light("AREA", 150.0, place(at=(0.0, 0.0, 3.5)), shape="SQUARE", size=1.0)


def touching_volumes() -> None:
    """Two boxes of other media side by side, with a face of each in the same place."""
    _floor_and_camera()
    box((0.6, 0.6, 0.6), medium("Left", scatter(1.0, (1.0, 0.8, 0.6))), place(at=(-0.6, 0.0, 1.0)))
    box((0.6, 0.6, 0.6), medium("Right", scatter(0.7, (0.5, 0.8, 1.0))), place(at=(0.6, 0.0, 1.0)))
    light("POINT", 200.0, place(at=(1.0, -1.5, 3.2)), shadow_soft_size=0.1)


def glass_ball_in_fog() -> None:
    """A ball of glass gathers light in a box of fog."""
    _floor_and_camera()
    box((1.4, 1.4, 1.2), medium("Fog", scatter(0.5)), place(at=(0.0, 0.0, 1.3)))
    ball(0.45, shader_material(GLASS, Roughness=0.0, IOR=1.45), place(at=(0.0, 0.0, 1.5)))
    light("AREA", 150.0, place(at=(0.6, 0.0, 3.6)), shape="SQUARE", size=0.9)


def phase_functions() -> None:
    """A box for each phase function, lit from the left."""
    scene = bpy.context.scene
    for number, (phase, inputs) in enumerate(PHASES.items()):
        fog = medium(phase, scatter(0.8, phase=phase, **inputs))
        column, row = number % 3, number // 3
        box((0.35, 0.35, 0.35), fog, place(at=(column - 1.0, 0.0, 0.5 - row)))
    sun = light("SUN", 3.0, place(turn=(0.0, -60.0, 20.0)))
    sun.data.angle = 0.1
    camera((0.0, -6.0, 0.0), (0.0, 0.0, 0.0), 32.0)
    scene.render.film_transparent = False


SCENES = {
    "fog in a cube": fog_in_a_cube,
    "spot in the world's fog": spot_in_the_worlds_fog,
    "overlapping volumes": overlapping_volumes,
    "touching volumes": touching_volumes,
    "glass ball in fog": glass_ball_in_fog,
    "phase functions": phase_functions,
}
