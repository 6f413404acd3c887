# SPDX-License-Identifier: GPL-3.0-or-later
"""Under Automatic, a device takes two levels where it does not hold the triangles of all instances, GPUs included."""

import dataclasses

import numpy as np
import pytest
import scenes
from rendering import radiance_of

from rppm_addon.gl.context.context import Context
from rppm_addon.integrator.device_scene import acceleration
from rppm_addon.integrator.device_scene.instancing import most_expanded_triangles
from rppm_addon.scene import AccelerationStructure, Instancing


@pytest.mark.parametrize("is_software", [True, False])
def test_what_does_not_fit_expanded_has_two_levels(mapper, monkeypatch, is_software):
    """A GPU rasterizes the camera's first hits where instances are expanded, and traces them here."""
    monkeypatch.setitem(vars(mapper.context), "is_software", is_software)
    automatic = scenes.crowded_room(16, photons=500, acceleration_structure=AccelerationStructure.BVH)
    settings = dataclasses.replace(automatic.settings, instancing=Instancing.TWO_LEVELS)
    expected = radiance_of(mapper, dataclasses.replace(automatic, settings=settings))
    mapper.update(automatic)
    assert mapper.device_scene.geometry.instanced is None
    with monkeypatch.context() as patch:
        patch.setattr(acceleration, "most_expanded_triangles", lambda context: automatic.triangle_count - 1)
        found = radiance_of(mapper, automatic)
        assert mapper.device_scene.geometry.instanced is not None
    np.testing.assert_array_equal(found, expected)


def test_room_follows_from_the_largest_buffer_and_from_the_memory(context, monkeypatch):
    def most(buffer: int, memory: int | None) -> int:
        monkeypatch.setattr(Context, "array_limit", lambda self, texel_bytes: buffer)
        monkeypatch.setattr(Context, "memory", property(lambda self: memory))
        return most_expanded_triangles(context)

    assert most(2 << 30, None) == (2 << 30) // 48
    assert most(2 << 30, 64 << 30) == (2 << 30) // 48
    assert 15_000_000 < most(2 << 30, 8 << 30) < 28_000_000
