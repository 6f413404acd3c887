# SPDX-License-Identifier: GPL-3.0-or-later
"""Coefficients of volume nodes: what is seen through a slab of a medium in Cycles, against RPPM's coefficients."""

from collections.abc import Callable

import bpy
import numpy as np
import pytest

from rppm_addon.integrator.progressive import ProgressivePhotonMapper
from rppm_addon.materials.records import MEDIUM

from ..engines import exported_scene, render_cycles, unfilter
from ..net import Net, material, socket
from ..scenes import box, new_scene, orthographic_camera, place, plane

LENGTH = 2.0
"""Thickness of the slab, m."""
COLOR, OTHER = (0.9, 0.5, 0.2), (0.3, 0.6, 1.5)


def two(kind: str, factor: object, first: Callable, second: Callable) -> Callable[[Net], object]:
    """A Mix Shader or Add Shader of two volumes."""
    inputs = {0: factor, 1: first, 2: second} if kind == "MixShader" else {0: first, 1: second}
    return socket(kind, inputs=inputs)


def grouped(net: Net):
    """An absorbing volume in a group whose density is a socket."""
    tree = bpy.data.node_groups.new("Fog", "ShaderNodeTree")
    tree.interface.new_socket("Density", in_out="INPUT", socket_type="NodeSocketFloat")
    tree.interface.new_socket("Volume", in_out="OUTPUT", socket_type="NodeSocketShader")
    inner = Net(tree)
    given, result = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    fog = inner.out("VolumeAbsorption", inputs={"Color": COLOR, "Density": given.outputs[0]})
    tree.links.new(fog, result.inputs[0])
    group = net.node("Group", node_tree=tree)
    group.inputs[0].default_value = 0.7
    return group.outputs[0]


ABSORPTION = socket("VolumeAbsorption", inputs={"Color": COLOR, "Density": 0.8})
SCATTER = socket("VolumeScatter", inputs={"Color": COLOR, "Density": 0.6, "Anisotropy": 0.3})
EMISSION = socket("Emission", inputs={"Color": COLOR, "Strength": 0.4})
GAS = {"Color": COLOR, "Density": 0.7, "Absorption Color": (0.04, 0.25, 0.5)}
BLACK_GAS = {"Color": 0.0, "Density": 0.5, "Absorption Color": 0.1}
FIRE = BLACK_GAS | {"Blackbody Tint": OTHER, "Temperature": 2500.0}


def principled(**inputs: object) -> Callable[[Net], object]:
    return socket("VolumePrincipled", inputs={name.replace("_", " "): value for name, value in inputs.items()})


CLEAR: dict[str, Callable[[Net], object]] = {
    "absorption": ABSORPTION,
    "negative density": two("AddShader", None, ABSORPTION, socket("VolumeAbsorption", inputs={"Density": -1.0})),
    "emission": EMISSION,
    "emission and absorption": two("AddShader", None, EMISSION, ABSORPTION),
    "mixed emission": two("MixShader", 0.25, ABSORPTION, EMISSION),
    "group": grouped,
    "coefficients": socket(
        "VolumeCoefficients",
        inputs={
            "Absorption Coefficients": (0.1, 0.4, 0.9), "Scatter Coefficients": (0.0,) * 3,
            "Emission Coefficients": (0.7, 0.2, 0.1),
        },
    ),
    "half of coefficients": two(
        "MixShader",
        0.5,
        socket(
            "VolumeCoefficients",
            inputs={
                "Absorption Coefficients": (0.1, 0.4, 0.9), "Scatter Coefficients": (0.0,) * 3,
                "Emission Coefficients": (0.7, 0.2, 0.1),
            },
        ),
        ABSORPTION,
    ),
    "principled that glows": principled(**BLACK_GAS, Emission_Strength=0.6, Emission_Color=OTHER),
    "principled without density that glows": principled(Density=0.0, Emission_Strength=0.6, Emission_Color=OTHER),
    "half of a principled that glows": two(
        "MixShader", 0.5, principled(**BLACK_GAS, Emission_Strength=0.6, Emission_Color=OTHER), ABSORPTION
    ),
    "fire": principled(**FIRE, Blackbody_Intensity=1.0),
    "half of a fire": two("MixShader", 0.5, principled(**FIRE, Blackbody_Intensity=1.0), ABSORPTION),
    "weak fire": principled(**FIRE, Blackbody_Intensity=0.3),
    "surfaces": two("AddShader", None, ABSORPTION, socket("BsdfPrincipled", inputs={"Emission Strength": 1.0})),
    "color": socket("RGB"),
}  # fmt: skip
"""Volumes that scatter nothing, which Cycles renders without noise."""
SCATTERING: dict[str, Callable[[Net], object]] = {
    "scatter": SCATTER,
    "scatter of a bright color": socket("VolumeScatter", inputs={"Color": OTHER, "Density": 0.5}),
    "mie": socket("VolumeScatter", inputs={"Color": COLOR, "Density": 0.6}, phase="MIE"),
    "scatter and absorption": two("AddShader", None, SCATTER, ABSORPTION),
    "mixed": two("MixShader", 0.3, SCATTER, ABSORPTION),
    "coefficients": socket("VolumeCoefficients", inputs={"Scatter Coefficients": (0.3, 0.2, 0.1)}),
    "principled": principled(**GAS),
    "principled with bright colors": principled(**GAS | {"Color": OTHER, "Absorption Color": (0.5, 2.0, 0.0)}),
    "principled without an attribute": principled(**GAS, Color_Attribute="color"),
}


def slab(volume: Callable[[Net], object]) -> None:
    """A slab before a card that shines and that only the camera sees."""
    scene = new_scene(8)
    orthographic_camera(1.0, place(at=(0.0, 0.0, 5.0)))
    inside, net = material("Volume")
    net.output(Volume=volume(net))
    box((3.0, 3.0, 0.5 * LENGTH), inside)
    glow, net = material("Glow")
    net.output(net.emission(1.0))
    card = plane(3.0, glow, place(at=(0.0, 0.0, -3.0)))
    for kind in ("diffuse", "glossy", "transmission", "volume_scatter", "shadow"):
        setattr(card, f"visible_{kind}", False)
    scene.cycles.volume_bounces = 0
    unfilter()


def coefficients(context, library) -> dict[str, np.ndarray]:
    """(3,) absorption and scattering, 1/m, and emission, W/(m^3 sr), of the only medium of the current scene."""
    with context.moderngl:
        mapper = ProgressivePhotonMapper(context, library)
        try:
            mapper.build(exported_scene())
            data = mapper.device_scene.materials.media.blocks["Media"].read()
        finally:
            mapper.release()
    medium = np.frombuffer(data, MEDIUM.dtype, 2)[1]
    return {name: medium[name].astype(np.float64) for name in ("absorption", "scattering", "emission")}


def seen(medium: dict[str, np.ndarray]) -> np.ndarray:
    """(3,) radiance of the card through the slab, but for light that is scattered."""
    extinction = medium["absorption"] + medium["scattering"]
    with np.errstate(invalid="ignore", divide="ignore"):
        length = np.where(extinction > 1e-6, -np.expm1(-extinction * LENGTH) / extinction, LENGTH)
    return np.exp(-extinction * LENGTH) + medium["emission"] * length


@pytest.mark.parametrize("name", CLEAR)
def test_media_that_scatter_nothing(context, library, name):
    slab(CLEAR[name])
    found = render_cycles(1, seeds=1).mean(axis=(0, 1, 2))
    medium = coefficients(context, library)
    assert not medium["scattering"].any()
    np.testing.assert_allclose(seen(medium), found, rtol=5e-4)


@pytest.mark.parametrize("name", SCATTERING)
def test_media_that_scatter(context, library, name):
    """By what gets through without being scattered, which is lost to sight."""
    slab(SCATTERING[name])
    pictures = render_cycles(4096, seeds=2)
    means = pictures.mean(axis=(1, 2))
    medium = coefficients(context, library)
    assert medium["scattering"].any()
    error = np.abs(means[0] - means[1]).max() + 1e-3
    np.testing.assert_allclose(seen(medium), means.mean(axis=0), atol=4.0 * error)
