# SPDX-License-Identifier: GPL-3.0-or-later
"""Volumes that scatter light, with Cycles' limits of bounces."""

import bpy
import pytest

from ..comparison import Tolerance
from ..engines import compare_with_cycles
from ..net import Net
from ..net import material as net_material
from ..scenes import DIFFUSE, GLASS, ball, box, camera, light, material, new_scene, place, plane

FOG = Tolerance(mean=0.01, block=0.03, mode=0.01)
NOISY = Tolerance(mean=0.02, block=0.03, mode=0.01)
"""Near a lamp in fog."""
SCATTER, COEFFICIENTS, PRINCIPLED = "VolumeScatter", "VolumeCoefficients", "VolumePrincipled"
ABSORPTION = "VolumeAbsorption"


def _volume(net: Net, *nodes: tuple[str, dict, dict]) -> bpy.types.NodeSocket:
    """The sum of volume nodes: kinds, inputs and properties."""
    found = [net.out(kind, 0, inputs, **properties) for kind, inputs, properties in nodes]
    total = found[0]
    for socket in found[1:]:
        total = net.out("AddShader", 0, {0: total, 1: socket})
    return total


def _fog(*nodes: tuple[str, dict, dict], surface: str | None = None, **inputs: object) -> bpy.types.Material:
    made, net = net_material("Fog")
    shown = None if surface is None else net.out(surface.removeprefix("ShaderNode"), 0, inputs)
    net.output(shown, Volume=_volume(net, *nodes))
    return made


def _scatter(density: float, anisotropy: float = 0.0, color: object = 1.0, **properties: object):
    return SCATTER, {"Color": color, "Density": density, "Anisotropy": anisotropy}, properties


def _floor() -> None:
    plane(3.0, material(DIFFUSE, Color=(0.8, 0.7, 0.6)), place(at=(0.0, 0.0, -1.01)))


OUTSIDE, INSIDE = (0.8, -0.6, 2.2), (0.7, 0.2, 0.6)


def _lamp(at: tuple[float, float, float]) -> None:
    """It is small, and without MIS: Cycles' MIS loses some of the light of the fog in it (test_scattered_light.py)."""
    lamp = light("POINT", 100.0, place(at=at), shadow_soft_size=0.02, use_soft_falloff=False)
    lamp.data.cycles.use_multiple_importance_sampling = at is not INSIDE


def _seen_with(*nodes: tuple[str, dict, dict], lamp: tuple[float, float, float] = OUTSIDE, half: float = 1.0) -> None:
    """A cube of fog above a floor."""
    new_scene()
    _floor()
    box((half, half, half), _fog(*nodes))
    _lamp(lamp)
    if lamp is INSIDE:  # beside what the camera sees
        camera((0.0, -5.0, 1.2), (-0.4, 0.0, -0.3), 14.0)
    else:
        camera((0.0, -5.0, 1.2), (0.0, 0.0, 0.0), 40.0)


def _compare(renderer, name: str, bounces: int = 8, samples: int = 256, tolerance: Tolerance = FOG, **settings) -> None:
    cycles = bpy.context.scene.cycles
    cycles.volume_bounces, cycles.max_bounces = bounces, 12
    settings = {"photons": 32768, "iterations": 24, "volume_bounces": bounces, "max_bounces": 12} | settings
    compare_with_cycles(renderer, f"fog_{name}", samples, tolerance, **settings)


@pytest.mark.parametrize("bounces", [pytest.param(0), pytest.param(1, marks=pytest.mark.long), 8])
@pytest.mark.parametrize("lamp", [OUTSIDE, INSIDE], ids=["outside", "inside"])
def test_a_cube(renderer, bounces, lamp):
    _seen_with(_scatter(1.0), lamp=lamp)
    tolerance = NOISY if lamp is INSIDE else FOG
    _compare(renderer, f"cube_{bounces}_{lamp is INSIDE}", bounces, tolerance=tolerance)


NODES = {
    "coefficients": [
        (
            COEFFICIENTS,
            {
                "Scatter Coefficients": (0.9, 0.5, 0.2),
                "Absorption Coefficients": (0.0, 0.3, 0.6),
                "Emission Coefficients": (0.0, 0.0, 0.0),
                "Anisotropy": 0.4,
            },
            {},
        )
    ],
    "principled": [
        (
            PRINCIPLED,
            {"Color": (0.8, 0.6, 0.4), "Density": 0.8, "Anisotropy": 0.3, "Absorption Color": (0.1, 0.2, 0.6)},
            {},
        )
    ],
    "absorption_and_scattering": [
        _scatter(0.7, -0.3, (0.9, 0.5, 0.3)),
        (ABSORPTION, {"Color": (0.3, 0.7, 0.9), "Density": 0.6}, {}),
    ],
}


@pytest.mark.parametrize(
    "nodes", [pytest.param(nodes, id=name, marks=pytest.mark.long) for name, nodes in NODES.items()]
)
def test_nodes(renderer, nodes, request):
    _seen_with(*nodes)
    _compare(renderer, request.node.callspec.id, 4)


@pytest.mark.long
def test_emission(renderer):
    _seen_with(_scatter(0.6, 0.0, (0.5, 0.8, 0.9)), ("Emission", {"Color": (1.0, 0.6, 0.3), "Strength": 0.2}, {}))
    _compare(renderer, "emission", 4)


MILK = COEFFICIENTS, {"Scatter Coefficients": (3.0, 2.8, 2.5), "Absorption Coefficients": (0.02, 0.05, 0.2)}, {}


def _milk_lit_by(size: float, radius: float = 1.0) -> None:
    """A ball of milk above a floor, under an area light that Cycles' paths find from within."""
    new_scene(world=0.3)
    _floor()
    ball(radius, _fog(MILK, surface=GLASS, Color=1.0, Roughness=0.0, IOR=1.3), segments=96)
    light("AREA", 150.0, place(at=(0.0, 0.0, 2.5)), shape="SQUARE", size=size)
    camera((0.0, -5.0, 1.2), (0.0, 0.0, 0.0), 32.0)
    bpy.context.scene.cycles.caustics_reflective = bpy.context.scene.cycles.caustics_refractive = True


@pytest.mark.long
def test_milk_in_a_ball_of_glass(renderer):
    _milk_lit_by(1.5)
    _compare(renderer, "milk", 12, 512)


@pytest.mark.long
def test_milk_that_overlaps_its_glass(renderer):
    """Around a core, which is in the milk."""
    _milk_lit_by(4.0, 0.94)
    clear = material(GLASS, Color=1.0, Roughness=0.0, IOR=1.5)
    ball(1.0, clear, segments=96)
    ball(0.9, clear, segments=96).data.flip_normals()
    ball(0.4, material(DIFFUSE, Color=(0.8, 0.1, 0.1)))
    _compare(renderer, "milk_in_glass", 12, 512)
