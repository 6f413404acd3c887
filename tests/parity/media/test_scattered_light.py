# SPDX-License-Identifier: GPL-3.0-or-later
"""Light that media scatter, with Cycles' limits of bounces."""

import pytest

from ..comparison import CAUSTIC, CONVERGED
from ..engines import compare_with_cycles
from .scenes import SCENES, begin

pytestmark = pytest.mark.skip(reason="the integrator does not scatter light in media yet")
PATHS = {"photons": 65536, "iterations": 24, "max_bounces": 64, "transparent_max_bounces": 64}


@pytest.mark.parametrize("volume_bounces", [0, pytest.param(8, marks=pytest.mark.long)])
@pytest.mark.parametrize("name", SCENES)
def test_media_scatter_as_in_cycles(renderer, name, volume_bounces):
    begin(volume_bounces)
    SCENES[name]()
    tolerance = CAUSTIC if name == "glass ball in fog" else CONVERGED
    label = f"media_{name.replace(' ', '_')}_{volume_bounces}"
    compare_with_cycles(renderer, label, 512, tolerance, volume_bounces=volume_bounces, **PATHS)
