# SPDX-License-Identifier: GPL-3.0-or-later
"""The limit on levels of a deep cubemap, learned from builds that the device had no room for."""

import pytest

from rppm_addon.integrator.deep_cubemap.build_buffers import LevelTooFineError
from rppm_addon.integrator.deep_cubemap.level_limit import LevelLimit
from rppm_addon.integrator.deep_cubemap.records import STATE
from rppm_addon.scene.errors import DeviceError


def parameters(triangle_count: int, base_level: int = 2, last_level: int = 7):
    state = STATE.zeros(1)[0]
    state["triangle_count"], state["base_level"], state["last_level"] = triangle_count, base_level, last_level
    return state


def test_builds_of_as_many_triangles_begin_with_what_was_learned():
    limit, first = LevelLimit(), parameters(1000)
    limit.lower(first, LevelTooFineError(5, DeviceError("entries need 9 MiB")))
    assert first["last_level"] == 4
    for triangle_count, last_level in ((999, 7), (1000, 4), (5000, 4)):
        later = parameters(triangle_count)
        limit.apply(later)
        assert later["last_level"] == last_level


def test_the_base_level_is_the_last_to_go():
    limit, state, error = LevelLimit(), parameters(1000, 2, 2), LevelTooFineError(2, DeviceError("jobs need 9 MiB"))
    limit.lower(state, error)
    assert (state["base_level"], state["last_level"]) == (1, 1)
    with pytest.raises(DeviceError, match="jobs need"):
        limit.lower(state, error)
