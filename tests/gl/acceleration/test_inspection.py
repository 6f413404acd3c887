# SPDX-License-Identifier: GPL-3.0-or-later
"""Cost of rays in the deep cubemap, as pictures."""

import dataclasses

import numpy as np
import pytest
import scenes

from rppm_addon.scene import Camera, Instancing


def looking_down(meshes, orthographic=False):
    """At the plane z = 0 from 2 m above, 4 x 3 m of it."""
    window = (-2.0, 2.0, -1.5, 1.5) if orthographic else (-1.0, 1.0, -0.75, 0.75)
    camera = Camera(scenes.placed(0, 0, 2), window, 40, 30, orthographic)
    return scenes.scene_of(camera, *((mesh, scenes.diffuse(1, 1, 1)) for mesh in meshes))


SQUARE = scenes.square("square", 1.0)


@pytest.mark.parametrize("orthographic", [False, True])
def test_costs_lie_where_the_geometry_is(renderer, orthographic):
    costs, counts, memory = renderer.inspect(looking_down([SQUARE], orthographic))
    assert costs.shape == (30, 40, 4) and np.isfinite(costs).all()
    steps, tests, listed, entries = np.moveaxis(costs, -1, 0)
    x, y = (np.arange(40) + 0.5) / 10 - 2, (np.arange(30) + 0.5) / 10 - 1.5
    on_square = (np.abs(x)[None, :] < 1) & (np.abs(y)[:, None] < 1)
    assert np.all((listed > 0) == on_square)
    assert listed.max() == 2  # along the diagonal
    assert np.all(tests[on_square] >= 1) and np.all(entries >= tests)
    assert np.all(steps[on_square] >= 1)
    assert counts["triangle"] == 2 and counts["entry"] > 0
    assert sum(memory.values()) > 0 and all("deep cubemap" in name for name in memory)


def test_nothing_costs_nothing(renderer):
    costs, counts, _ = renderer.inspect(looking_down([]))
    assert not costs.any() and counts["triangle"] == 0


def test_crowds_have_long_lists_or_fine_cells(renderer):
    """A ball of 20 000 triangles beside the square: cells get finer, lists stay short."""
    ball = scenes.sphere("ball", 200, 100)
    costs, counts, _ = renderer.inspect(looking_down([SQUARE, ball]))
    plain = renderer.inspect(looking_down([SQUARE]))[1]
    assert counts["resolution"] > plain["resolution"]
    assert np.median(costs[..., 2][costs[..., 2] > 0]) < 100


def test_instances_cost_where_they_are(renderer):
    """Twenty balls beside the square: every hit lies in a cell that lists what it is on, triangles or instances."""
    scene = looking_down([SQUARE, scenes.sphere("ball")])
    places = np.random.default_rng(3).uniform((-1.8, -1.4, -0.5), (1.8, 1.4, 0.5), (20, 3))
    scene.instances[1:] = [dataclasses.replace(scene.instances[1], matrix=scenes.placed(*at, 0.2)) for at in places]
    found = []
    for instancing in (Instancing.EXPANDED, Instancing.TWO_LEVELS):
        scene.settings.instancing = instancing
        costs, counts, _ = renderer.inspect(scene)
        found.append((costs, counts["triangle"]))
    (expanded, triangles), (in_levels, world_triangles) = found
    assert (triangles, world_triangles) == (2 + 20 * 960, 2)
    np.testing.assert_array_equal(in_levels[..., 2] > 0, expanded[..., 2] > 0)
    steps, tests, listed, entries = np.moveaxis(in_levels, -1, 0)
    assert (steps[listed > 0] >= 1).all() and (tests[listed > 0] >= 1).all() and (entries[listed > 0] >= 1).all()


def test_the_pass_comes_with_the_frame_if_asked_for(renderer):
    scene = looking_down([SQUARE])
    scene.world.radiance = np.ones(3)
    scene.settings.iterations, scene.settings.photons = 1, 16
    assert "Deep Cubemap" not in renderer.render(scene).frame.passes
    scene.settings.passes = ("Deep Cubemap",)
    found = renderer.render(scene).frame.passes["Deep Cubemap"]
    np.testing.assert_array_equal(found, renderer.inspect(scene)[0][..., :3])
