# SPDX-License-Identifier: GPL-3.0-or-later
"""Translucent sheets, rough diffuse surfaces and sheen in whole scenes, against Cycles.

All of them scatter photons, light by next-event rays, gathering rays and importons alike.
"""

import bpy
import numpy as np
import pytest

from rppm_addon.scene import Lobe, LobeKind, Scene

from .comparison import CONVERGED, compare
from .scenes import (
    DIFFUSE,
    ball,
    camera,
    exported_scene,
    light,
    material,
    new_scene,
    place,
    plane,
    render_cycles,
)

TRANSLUCENT, SHEEN = "ShaderNodeBsdfTranslucent", "ShaderNodeBsdfSheen"
RED, GREEN, BLUE = (0.8, 0.4, 0.3), (0.3, 0.7, 0.4), (0.3, 0.4, 0.8)


def lobes_of(kind: str, color: tuple, roughness: float) -> list[Lobe]:
    """What the material of one node is to RPPM."""
    kinds = {DIFFUSE: LobeKind.DIFFUSE, TRANSLUCENT: LobeKind.TRANSLUCENT, SHEEN: LobeKind.SHEEN}
    return [Lobe(kinds[kind], color=color, roughness=roughness)]


SURFACES = {
    # name: the sheet's or ball's node, its colour and roughness
    "translucent": (TRANSLUCENT, RED, 0.0),
    "rough": (DIFFUSE, RED, 1.0),
    "sheen": (SHEEN, RED, 0.6),
}


def sheet_in_a_corner(name: str) -> None:
    """A sheet above a floor, a wall beside it: light comes through, off the floor and off the wall."""
    kind, color, roughness = SURFACES[name]
    inputs = {"Color": color} | ({"Roughness": roughness} if roughness else {})
    plane(3.0, material(DIFFUSE, Color=GREEN))
    plane(3.0, material(DIFFUSE, Color=BLUE), place(at=(0.0, 2.0, 2.0), turn=(90.0, 0.0, 0.0)))
    sheet = material(kind, **inputs)
    plane(1.1, sheet, place(at=(0.0, 0.4, 1.4), turn=(35.0, 10.0, 0.0)))
    ball(0.5, sheet, place(at=(0.9, -0.6, 0.6)))
    light("AREA", 150.0, place(at=(0.5, 0.0, 4.5), turn=(5.0, 0.0, 0.0)), shape="SQUARE", size=1.5)
    camera((-0.8, -4.5, 1.2), (0.2, 0.3, 1.1), 45.0)


def render_with(renderer, name: str, seeds: int, **settings) -> np.ndarray:
    """(seeds, H, W, 4) pictures of the current Blender scene."""
    scene = exported_scene_with(name)
    pictures = []
    for seed in range(seeds):
        scene.settings = scene.settings.with_values(seed=seed, **settings)
        pictures.append(renderer.render(scene).frame.combined.astype(np.float64))
    return np.array(pictures)


def exported_scene_with(name: str) -> Scene:
    """The current Blender scene with the surface of that name."""
    # The node is swapped for a diffuse one while the scene is exported.
    kind, color, roughness = SURFACES[name]
    sheet = bpy.data.objects["Mesh.002"].data.materials[0]
    node = next(node for node in sheet.node_tree.nodes if node.bl_idname == kind)
    standing_in = sheet.node_tree.nodes.new(DIFFUSE)
    output = next(node for node in sheet.node_tree.nodes if node.bl_idname == "ShaderNodeOutputMaterial")
    sheet.node_tree.links.new(standing_in.outputs[0], output.inputs["Surface"])
    scene = exported_scene()
    sheet.node_tree.links.new(node.outputs[0], output.inputs["Surface"])
    exported = next(made for made in scene.materials if made.name == sheet.name)
    exported.lobes = lobes_of(kind, color, roughness)
    return scene


MODES = {
    "rays": {"direct_light": "RAYS", "photons": 8192, "iterations": 16},
    "photons": {"direct_light": "PHOTONS", "photons": 65536, "iterations": 10, "final_gather": False},
}


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("name", SURFACES)
def test_scattering(renderer, name, mode):
    new_scene()
    sheet_in_a_corner(name)
    reference = render_cycles(samples=256)
    pictures = render_with(renderer, name, 2, photon_path_length=6, **MODES[mode])
    compare(f"scattering_{name}_{mode}", pictures[..., :3], reference, CONVERGED)
