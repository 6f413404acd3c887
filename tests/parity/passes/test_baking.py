# SPDX-License-Identifier: GPL-3.0-or-later
"""Textures baked beside those that Cycles bakes of the same objects."""

import bpy
import numpy as np
import pytest
from support.baking import add_uv_map, bake

from ..comparison import Tolerance, compare
from ..engines import FIRST_SEED
from ..net import Net
from ..scenes import DIFFUSE, GLASS, background, ball, box, camera, light, material, new_scene, place, plane

SIZE = 32
DATA = ("EMIT", "UV", "NORMAL", "POSITION", "ENVIRONMENT")
LIGHT = Tolerance(mean=0.03, block=0.06, mode=0.03)
CLEAN = Tolerance(mean=0.01, block=0.03, mode=0.01)


@pytest.fixture(autouse=True)
def in_blender(registered):
    """RPPM is an engine of Blender here."""


def shining(**inputs):
    """A varnished material that glows in checks over its UV map."""
    made = material("ShaderNodeBsdfPrincipled", Emission_Strength=0.5, **inputs)
    net = Net(made.node_tree)
    checks = net.out("TexChecker", "Color", {"Vector": net.out("UVMap"), "Scale": 6.0})
    net.set(net.find("BSDF_PRINCIPLED").inputs["Emission Color"], checks)
    return made


def room():
    """A floor under a ball of glass and a box, turned, mirrored and shining, each with a UV map."""
    scene = new_scene(SIZE, world=0.3)
    scene.render.bake.margin = 0
    floor = plane(1.0, material(DIFFUSE, Color=(0.7, 0.5, 0.3)), place(at=(0.0, 0.0, -0.5)))
    surface = shining(Base_Color=(0.2, 0.6, 0.9), Roughness=0.5)
    crate = box((0.2, 0.25, 0.2), surface, place(at=(-0.5, 0.1, -0.2), turn=(10.0, 20.0, 30.0), scale=(-1.0, 1.0, 1.0)))
    ball(0.3, material(GLASS, Color=(1.0, 1.0, 1.0), Roughness=0.0, IOR=1.4), place(at=(0.4, 0.0, 0.0)))
    light("AREA", 20.0, place(at=(0.2, 0.2, 2.0)), shape="SQUARE", size=0.6)
    for owner in (floor, crate):
        add_uv_map(owner)
    return scene, floor, crate


def by_cycles(scene, baked, samples, seed=0, **arguments):
    scene.render.engine, scene.cycles.samples, scene.cycles.seed = "CYCLES", samples, FIRST_SEED + seed
    return bake(baked, SIZE, **arguments)


def by_rppm(scene, baked, samples, seed=0, photons=0, **arguments):
    scene.render.engine, scene.rppm.samples, scene.rppm.seed, scene.rppm.photons = "RPPM", samples, seed, photons
    return bake(baked, SIZE, **arguments)


def both(scene, baked, kind, **arguments):
    """Without noise: RPPM's and Cycles', (SIZE, SIZE, 3), of the middles of the texels."""
    mine, theirs = (engine(scene, baked, 1, type=kind, **arguments) for engine in (by_rppm, by_cycles))
    assert theirs[..., :3].std() > 0.01, "nothing is shown"
    return mine[..., :3], theirs[..., :3]


@pytest.mark.parametrize("kind", DATA)
def test_data_is_that_of_cycles(kind):
    scene, _, crate = room()
    sky = Net(scene.world.node_tree)
    sky.set(background().inputs["Color"], sky.out("TexNoise", "Color", {"Scale": 1.5, "Detail": 0.0}))
    mine, theirs = both(scene, crate, kind, normal_space="OBJECT")
    np.testing.assert_allclose(mine, theirs, atol=2e-3 if kind == "ENVIRONMENT" else 1e-4)


def test_normals_in_tangent_space_are_those_of_cycles():
    scene, _, crate = room()
    crate.data.shade_smooth()
    mine, theirs = both(scene, crate, "NORMAL", normal_space="TANGENT")
    np.testing.assert_allclose(mine, theirs, atol=2e-4)


def test_colors_are_those_of_cycles():
    scene, _, crate = room()
    for kind in ("DIFFUSE", "GLOSSY"):
        mine, theirs = (bake(scene, crate, 1, type=kind, pass_filter={"COLOR"}) for bake in (by_rppm, by_cycles))
        np.testing.assert_allclose(mine[..., :3], theirs[..., :3], rtol=0.01, atol=2e-3)


@pytest.mark.parametrize("view", ["ABOVE_SURFACE", "ACTIVE_CAMERA"])
def test_direct_light_is_that_of_cycles(view):
    """The light that varnish reflects depends on the direction from which it is seen."""
    scene, _, crate = room()
    camera((0.0, -3.0, 1.0), (0.0, 0.0, 0.0))
    scene.render.bake.view_from = view
    options = {"type": "COMBINED", "pass_filter": {"DIRECT", "DIFFUSE", "GLOSSY", "EMIT"}}
    theirs = np.array([by_cycles(scene, crate, 128, seed, **options) for seed in range(2)], np.float64)
    mine = np.array([by_rppm(scene, crate, 24, seed, 64, **options) for seed in range(2)], np.float64)
    compare(f"baked_{view.lower()}", mine[..., :3], theirs[..., :3], CLEAN)


def test_normals_of_the_selected_on_the_active_are_those_of_cycles():
    scene, floor, crate = room()
    floor.matrix_world = place(at=(-0.5, 0.1, 0.2), scale=(0.5, 0.5, 1.0))
    bpy.context.view_layer.update()
    options = {"others": (crate,), "use_selected_to_active": True, "cage_extrusion": 0.3}
    mine, theirs = both(scene, floor, "NORMAL", **options)
    np.testing.assert_allclose(mine, theirs, atol=2e-4)


@pytest.mark.long
@pytest.mark.parametrize("contents", [{"DIRECT", "INDIRECT", "COLOR"}, {"INDIRECT"}], ids=["all", "indirect"])
def test_light_is_that_of_cycles(contents):
    """With the shadow and the caustic of a ball of glass on the floor, by photons and shadow rays."""
    scene, floor, _ = room()
    options = {"type": "DIFFUSE", "pass_filter": contents}
    theirs = np.array([by_cycles(scene, floor, 1024, seed, **options) for seed in range(2)], np.float64)
    mine = np.array([by_rppm(scene, floor, 40, seed, 8192, **options) for seed in range(2)], np.float64)
    compare("baked_" + "_".join(sorted(contents)).lower(), mine[..., :3], theirs[..., :3], LIGHT)
