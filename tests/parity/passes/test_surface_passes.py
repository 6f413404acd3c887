# SPDX-License-Identifier: GPL-3.0-or-later
"""Ambient occlusion and roughness beside Cycles', as passes and baked."""

import bpy
import numpy as np
import pytest
from support.baking import add_uv_map, bake

from ..comparison import Tolerance, compare
from ..engines import cycles_channels, exported_scene, render_frame, stacked, unfilter
from ..net import Net
from ..net import material as net_material
from ..scenes import DIFFUSE, GLOSSY, ball, box, camera, material, new_scene, place, plane

SIZE = 32
WITHIN = Tolerance(mean=0.01, block=0.04, mode=0.01)


def half_transparent(color) -> bpy.types.Material:
    """A pane that lets some of each color pass."""
    return _mixed(lambda net: net.out("BsdfTransparent", 0, {"Color": color}), DIFFUSE, 0.4)


def _mixed(other, shader: str, factor: float) -> bpy.types.Material:
    """A shader, and another one in place of this part of it."""
    made, net = net_material("Mixed")
    net.output(net.out("MixShader", 0, {0: factor, 1: net.out(shader.removeprefix("ShaderNode"), 0), 2: other(net)}))
    return made


def corner(distance: float) -> tuple[bpy.types.Object, bpy.types.Object]:
    """A floor and a box on it beneath a pane, before a bright world."""
    scene = new_scene(SIZE, world=1.0)
    scene.world.light_settings.distance = distance
    scene.render.bake.margin = 0
    floor = plane(1.5, material(DIFFUSE, Color=(0.7, 0.5, 0.3)))
    crate = box((0.3, 0.3, 0.4), material(GLOSSY, Roughness=0.2), place(at=(0.0, 0.1, 0.45), turn=(0.0, 0.0, 30.0)))
    plane(0.5, half_transparent((1.0, 0.6, 0.2)), place(at=(0.5, -0.4, 0.5)))
    ball(0.25, material(DIFFUSE, Color=0.2), place(at=(-0.7, -0.3, 0.25)))
    camera((0.3, -3.5, 2.2), (0.0, 0.0, 0.2), 40.0)
    for owner in (floor, crate):
        add_uv_map(owner)
    return floor, crate


@pytest.mark.parametrize("distance", [0.5, pytest.param(10.0, marks=pytest.mark.long)])
def test_ambient_occlusion_is_that_of_cycles(renderer, distance):
    corner(distance)
    scene = bpy.context.scene
    scene.view_layers[0].use_pass_ambient_occlusion = True
    unfilter()
    theirs = stacked(cycles_channels(2048), "Ambient Occlusion").astype(np.float64)[None]
    exported = exported_scene()
    assert "Ambient Occlusion" in exported.settings.passes
    mine = [
        render_frame(renderer, seed=seed, iterations=128, photons=64, filter_width=0.0, passes=("Ambient Occlusion",))
        .passes["Ambient Occlusion"]
        .astype(np.float64)
        for seed in range(2)
    ]
    assert theirs.min() == 0.0 and 0.9 < theirs.max() < 1.1 and np.ptp(theirs, axis=-1).max() > 0.05
    compare(f"ambient_occlusion_{distance}", np.array(mine), theirs, WITHIN)


def both(baked: bpy.types.Object, kind: str, samples: tuple[int, int]) -> list[np.ndarray]:
    """RPPM's and Cycles', (1, SIZE, SIZE, 3)."""
    scene, found = bpy.context.scene, []
    for engine, count in zip(("RPPM", "CYCLES"), samples, strict=True):
        scene.render.engine, scene.cycles.samples, scene.rppm.samples = engine, count, count
        found.append(bake(baked, SIZE, type=kind)[None, ..., :3].astype(np.float64))
    return found


def test_baked_ambient_occlusion_is_that_of_cycles(registered):
    for number, owner in enumerate(corner(1.0)):
        compare(f"baked_occlusion_{number}", *both(owner, "AO", (128, 1024)), WITHIN)


def principled(**inputs: object) -> bpy.types.Material:
    """A Principled material."""
    return material("ShaderNodeBsdfPrincipled", Base_Color=(0.8, 0.4, 0.2), **inputs)


def textured() -> bpy.types.Material:
    """Glossy, as rough as a gradient over its UV map is bright."""
    made = material(GLOSSY)
    net = Net(made.node_tree)
    net.set(net.find("BSDF_GLOSSY").inputs["Roughness"], net.out("TexGradient", "Fac", {"Vector": net.out("UVMap")}))
    return made


MATERIALS = {
    "diffuse": lambda: material(DIFFUSE, Color=0.8),
    "rough diffuse": lambda: material(DIFFUSE, Color=0.8, Roughness=0.3),
    "glossy": lambda: material(GLOSSY, Roughness=0.2, Anisotropy=0.5),
    "glass": lambda: material("ShaderNodeBsdfGlass", Roughness=0.2),
    "translucent": lambda: material("ShaderNodeBsdfTranslucent"),
    "emission": lambda: material("ShaderNodeEmission"),
    "Principled": lambda: principled(Roughness=0.5),
    "metal": lambda: principled(Roughness=0.3, Metallic=0.5),
    "coat": lambda: principled(Roughness=0.5, Coat_Weight=1.0, Coat_Roughness=0.1),
    "transmission": lambda: principled(Roughness=0.5, Transmission_Weight=0.5),
    "textured": textured,
    "mixed": lambda: _mixed(lambda net: net.out("BsdfRefraction", 0, {"Roughness": 0.6}), GLOSSY, 0.3),
}


@pytest.mark.parametrize("name", MATERIALS)
def test_baked_roughness_is_that_of_cycles(registered, name):
    new_scene(SIZE, world=0.3)
    owner = plane(1.0, MATERIALS[name]())
    add_uv_map(owner)
    mine, theirs = both(owner, "ROUGHNESS", (1, 1))
    assert theirs.max() > 0.05
    # Cycles gives what is below a coat another weight than the coat's light leaves for it.
    np.testing.assert_allclose(mine, theirs, rtol=0.04 if name == "coat" else 0.01, atol=2e-3)
