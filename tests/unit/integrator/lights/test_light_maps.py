# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps of lights: how they lie side by side, and their means."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rppm_addon.integrator.lights.light_maps import bordered, mean_of, packed_places
from rppm_addon.materials.evaluation import MapShape
from rppm_addon.materials.traits.emitted import light_variation
from rppm_addon.scene import Light, LightKind, NodeGraph


@settings(deadline=None, derandomize=True)
@given(st.lists(st.tuples(st.integers(1, 60), st.integers(1, 60)), max_size=20), st.integers(64, 200))
def test_maps_lie_side_by_side(sizes, widest):
    places, (width, height) = packed_places(dict(enumerate(sizes)), widest)
    assert width <= widest and height <= widest and len(places) == len(sizes)
    used = np.zeros((height, width), int)
    for x, y, across, up in places.values():
        used[y : y + up + 2, x : x + across + 2] += 1
        assert x + across + 2 <= width and y + up + 2 <= height
    assert used.max(initial=0) <= 1


def test_many_maps_become_smaller():
    places, (width, height) = packed_places(dict.fromkeys(range(200), (1024, 512)), 4100)
    assert width * height <= 1 << 24 and len({place[2:] for place in places.values()}) == 1


def test_spheres_go_on_at_their_seam():
    pixels = np.arange(2 * 4, dtype=float).reshape(2, 4, 1) * np.ones(3)
    around, flat = bordered(pixels, MapShape.NORMALS)[..., 0], bordered(pixels, MapShape.PLACES)[..., 0]
    np.testing.assert_array_equal(around[1], [3, 0, 1, 2, 3, 0])
    np.testing.assert_array_equal(flat[1], [0, 0, 1, 2, 3, 3])
    np.testing.assert_array_equal(around[0], around[1])


def test_means_are_over_what_shines():
    height = np.cos(np.pi * (1.0 - (np.arange(256) + 0.5) / 256))  # of directions upwards
    pixels = np.maximum(-height, 0.0)[:, None, None] * np.ones((256, 512, 3))
    point = Light("point", LightKind.POINT, np.eye(4), np.ones(3))
    assert mean_of(pixels, point, MapShape.DIRECTIONS) == pytest.approx(np.full(3, 0.25), rel=1e-3)
    corners = np.ones((64, 64, 3))
    corners[8:-8, 8:-8] = 0.0
    area = Light("area", LightKind.AREA, np.eye(4), np.ones(3))
    assert mean_of(corners, area, MapShape.PLACES) == pytest.approx(np.full(3, 1.0 - 0.75**2))
    area.shape = "DISK"
    assert (mean_of(corners, area, MapShape.PLACES) < 1.0 - 0.75**2).all()


@pytest.mark.parametrize(
    ("kind", "output", "what"),
    [
        ("tex_coord", "normal", "place"),
        ("new_geometry", "position", "place"),
        ("generated_coord", "generated", "place"),
        ("new_geometry", "incoming", "direction"),
        ("tex_coord", "uv", "uv"),
        ("light_path", "ray_length", "distance"),
    ],
)
def test_what_lights_vary_by(kind, output, what):
    graph = NodeGraph()
    graph.surface = graph.add("emission", "emission", color=graph.add(kind, output))
    varies = light_variation(graph)
    found = {name for name in ("place", "direction", "uv", "distance") if getattr(varies, name)}
    assert found == {what} and bool(varies) == (what != "distance")
