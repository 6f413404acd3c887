# SPDX-License-Identifier: GPL-3.0-or-later
"""Procedural textures from Blender's nodes to the picture: sockets, properties and coordinates find their places."""

import bpy
import pytest

from ..engines import compare_with_cycles
from ..net import material
from ..scenes import camera, new_scene, place, plane

TILES = [
    ("TexNoise", "Color", {"noise_type": "HETERO_TERRAIN", "noise_dimensions": "4D"}, {"W": 1.3, "Offset": 0.6}),
    ("TexVoronoi", "Color", {"feature": "F2", "distance": "MANHATTAN"}, {"Scale": 3.0, "Randomness": 0.7}),
    ("TexWave", "Color", {"wave_type": "RINGS", "rings_direction": "Z", "wave_profile": "TRI"}, {"Scale": 0.4}),
    ("TexMagic", "Color", {"turbulence_depth": 4}, {"Scale": 1.0, "Distortion": 1.4}),
    ("TexGradient", "Color", {"gradient_type": "EASING"}, {}),
    ("TexChecker", "Color", {}, {"Scale": 3.0, "Color1": (0.9, 0.2, 0.1, 1.0)}),
    (
        "TexBrick",
        "Color",
        {"offset": 0.3, "offset_frequency": 3, "squash": 0.5, "squash_frequency": 2},
        {"Scale": 2.0, "Mortar": (0.1, 0.3, 0.8, 1.0), "Mortar Size": 0.05},
    ),
    ("TexWhiteNoise", "Color", {"noise_dimensions": "4D"}, {"W": 0.4}),
    ("TexGabor", "Value", {"gabor_type": "3D"}, {"Scale": 2.0, "Orientation 3D": (0.3, 0.5, 0.1)}),
]
"""Node, output, properties and inputs; the coordinates are those that textures have without a link
(white noise: none)."""


def _material(kind: str, output: str, properties: dict, inputs: dict) -> bpy.types.Material:
    """Return a material that emits the texture's output as light."""
    made, net = material(kind)
    texture, emission, surface = net.node(kind, **properties), net.node("Emission"), net.node("OutputMaterial")
    for name, value in inputs.items():
        next(socket for socket in texture.inputs if socket.identifier == name).default_value = value
    net.set(emission.inputs["Color"], texture.outputs[output])
    net.set(surface.inputs["Surface"], emission.outputs[0])
    return made


@pytest.mark.long
def test_tiles_of_all_textures(renderer):
    new_scene()
    for number, tile in enumerate(TILES):
        column, row = number % 3 - 1, number // 3 - 1
        plane(0.4, _material(*tile), place(at=(1.1 * column, 1.1 * row, 0.0), turn=(0.0, 0.0, 4.0 * number)))
    camera((0.0, 0.0, 6.0), (0.0, 0.0, 0.0), 32.0)
    compare_with_cycles(renderer, "textures", 256, photons=256, photon_path_length=1, iterations=64)
