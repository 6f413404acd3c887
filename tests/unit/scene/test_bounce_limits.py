# SPDX-License-Identifier: GPL-3.0-or-later
"""Limits of bounces by type."""

import pytest

from rppm_addon.scene import RenderSettings
from rppm_addon.scene.settings.light_paths import NO_BOUNCE_LIMIT as NONE


@pytest.mark.parametrize(
    ("values", "limits"),
    [
        ({}, (NONE, NONE, NONE, NONE)),
        ({"diffuse_bounces": 4, "glossy_bounces": 0}, (4, 0, NONE, NONE)),
        ({"transmission_bounces": 12, "max_bounces": 12}, (NONE, NONE, NONE, NONE)),
        ({"transmission_bounces": 254, "glossy_bounces": 255, "max_bounces": 1024}, (NONE, NONE, 254, NONE)),
    ],
)
def test_limits_that_the_limit_of_all_does_not_imply(values, limits):
    settings = RenderSettings(**values)
    assert settings.bounce_limits == limits
    assert settings.limits_bounces_by_type == (limits != (NONE, NONE, NONE, NONE))
