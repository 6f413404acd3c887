# SPDX-License-Identifier: GPL-3.0-or-later
"""Media that emit light: what they shine on, and what media scatter of it."""

import bpy
import pytest

from ..comparison import CAUSTIC, Tolerance
from ..engines import compare_with_cycles
from ..net import Net, diffuse, material
from ..scenes import ball, box, camera, new_scene, place, plane

DISTANT = Tolerance(mean=0.03, block=0.06, mode=0.03)
GLOW = Tolerance(mean=0.01, block=0.03, mode=0.01)


def _room() -> None:
    """A floor and a wall, and a ball in between."""
    plane(3.0, diffuse("Floor", (0.8, 0.7, 0.6)), place(at=(0.0, 0.0, -1.2)))
    plane(3.0, diffuse("Wall", (0.5, 0.6, 0.8)), place(at=(0.0, 1.8, 0.0), turn=(90.0, 0.0, 0.0)))
    ball(0.4, diffuse("Ball", (0.7, 0.7, 0.7)), place(at=(1.3, -0.4, -0.8)), segments=32)
    camera((0.0, -6.0, 1.2), (0.0, 0.0, -0.1), 40.0)


def _emission(net: Net, color: tuple[float, float, float], strength: object) -> bpy.types.NodeSocket:
    return net.out("Emission", inputs={"Color": color, "Strength": strength})


def _sum(net: Net, *parts: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
    total = parts[0]
    for part in parts[1:]:
        total = net.out("AddShader", inputs={0: total, 1: part})
    return total


def absorbing_cube() -> bpy.types.Object:
    """A turned cube that absorbs and shines."""
    _room()
    made, net = material("Glow")
    absorbing = net.out("VolumeAbsorption", inputs={"Color": (0.3, 0.6, 0.8), "Density": 0.8})
    net.output(Volume=_sum(net, absorbing, _emission(net, (1.0, 0.6, 0.3), 1.5)))
    return box((0.5, 0.3, 0.7), made, place(at=(-0.3, 0.2, 0.0), turn=(20.0, 35.0, 10.0)))


def scattering_cube() -> bpy.types.Object:
    """A cube that scatters its own light."""
    _room()
    made, net = material("Glow")
    scattering = net.out("VolumeScatter", inputs={"Color": (0.9, 0.8, 0.6), "Density": 1.5, "Anisotropy": 0.3})
    net.output(Volume=_sum(net, scattering, _emission(net, (1.0, 0.6, 0.3), 1.0)))
    return box((0.7, 0.7, 0.7), made, place(at=(-0.2, 0.2, 0.0)))


def beside_fog() -> None:
    """A small thing that shines, in a larger box of fog."""
    _room()
    fog, net = material("Fog")
    net.output(Volume=net.out("VolumeScatter", inputs={"Color": (0.8, 0.9, 1.0), "Density": 0.5}))
    box((1.0, 0.9, 0.9), fog, place(at=(-0.3, 0.0, 0.0)))
    made, net = material("Glow")
    net.output(Volume=_emission(net, (1.0, 0.5, 0.2), 3.0))
    ball(0.5, made, place(at=(-0.6, 0.2, 0.2)), segments=32)


def glow_in_glass() -> None:
    """A ball of glass with a medium inside that absorbs and shines."""
    _room()
    made, net = material("Glow")
    absorbing = net.out("VolumeAbsorption", inputs={"Color": (0.9, 0.5, 0.2), "Density": 0.5})
    glass = net.out("BsdfGlass", inputs={"Color": 1.0, "Roughness": 0.0, "IOR": 1.4})
    net.output(glass, Volume=_sum(net, absorbing, _emission(net, (0.3, 0.8, 1.0), 2.0)))
    ball(0.6, made, place(at=(-0.3, 0.0, 0.0)), segments=96)


def _noise(net: Net, low: float, high: float, to: float) -> bpy.types.NodeSocket:
    noise = net.out("TexNoise", inputs={"Vector": net.out("TexCoord", "Object"), "Scale": 2.0, "Detail": 1.0})
    return net.out("MapRange", inputs={"Value": noise, "From Min": low, "From Max": high, "To Max": to})


def varying_glow() -> None:
    """A box in which emission, scattering and absorption vary."""
    _room()
    made, net = material("Glow")
    scattering = net.out("VolumeScatter", inputs={"Color": (0.9, 0.8, 0.7), "Density": _noise(net, 0.4, 0.7, 2.0)})
    net.output(Volume=_sum(net, scattering, _emission(net, (1.0, 0.5, 0.2), _noise(net, 0.5, 0.7, 6.0))))
    box((0.7, 0.5, 0.8), made, place(at=(-0.2, 0.2, 0.0), turn=(0.0, 20.0, 30.0)))


def _shining_world(kind: str, density: float) -> None:
    _room()
    net = Net(bpy.context.scene.world.node_tree)
    volume = net.out(kind, inputs={"Color": (0.8, 0.7, 0.5), "Density": density})
    total = _sum(net, volume, _emission(net, (0.4, 0.7, 1.0), 0.1))
    net.tree.links.new(total, net.find("OUTPUT_WORLD").inputs["Volume"])


def glowing_world(density: float = 1.0) -> None:
    """A world whose medium scatters and shines."""
    _shining_world("VolumeScatter", density)


def absorbing_world() -> None:
    """A world whose medium absorbs and shines."""
    _shining_world("VolumeAbsorption", 0.5)


def _compare(renderer, name: str, bounces: int, samples: int = 512, tolerance: Tolerance = GLOW, **settings) -> None:
    cycles = bpy.context.scene.cycles
    cycles.volume_bounces, cycles.max_bounces = bounces, 12
    settings = {"photons": 16384, "iterations": 24, "volume_bounces": bounces, "max_bounces": 12} | settings
    compare_with_cycles(renderer, f"glow_{name}", samples, tolerance, **settings)


@pytest.mark.long
@pytest.mark.parametrize("bounces", [0, 2])
def test_scattered_glow(renderer, bounces):
    new_scene()
    scattering_cube()
    _compare(renderer, f"scattering_{bounces}", bounces)


@pytest.mark.long
@pytest.mark.parametrize(
    "scene", [absorbing_cube, beside_fog, varying_glow, absorbing_world], ids=lambda scene: scene.__name__
)
def test_glow(renderer, scene):
    new_scene()
    scene()
    _compare(renderer, scene.__name__, 4)


@pytest.mark.long
def test_a_world_that_scatters_its_own_light(renderer):
    """Few photons come to the scene from all around it."""
    new_scene()
    glowing_world()
    _compare(renderer, "world", 4, tolerance=DISTANT, photons=65536, iterations=16)


@pytest.mark.long
@pytest.mark.parametrize("rays", ["camera", "diffuse"])
def test_glow_that_is_hidden(renderer, rays):
    """Rays do not enter a volume that is hidden from them: the camera sees what it shines on, or no surface takes its
    light."""
    new_scene()
    setattr(absorbing_cube(), f"visible_{rays}", False)
    _compare(renderer, f"hidden_from_{rays}", 4)


@pytest.mark.long
def test_glow_in_glass(renderer):
    new_scene()
    glow_in_glass()
    bpy.context.scene.cycles.caustics_reflective = bpy.context.scene.cycles.caustics_refractive = True
    _compare(renderer, "glass", 4, tolerance=CAUSTIC)
