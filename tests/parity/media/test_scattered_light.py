# SPDX-License-Identifier: GPL-3.0-or-later
"""Light that media scatter, with Cycles' limits of bounces."""

import pytest

from ..comparison import CAUSTIC, CONVERGED
from ..engines import compare_with_cycles
from ..scenes import box, camera, light, place
from .scenes import SCENES, begin, medium, scatter

PATHS = {"photons": 65536, "iterations": 24, "max_bounces": 64, "transparent_max_bounces": 64}
CASES = [
    pytest.param(
        name,
        bounces,
        id=f"{name}-{bounces}",
        marks=[pytest.mark.long] * (bounces > 0),
    )
    for name in SCENES
    for bounces in (0, 8)
    if bounces or name != "glass ball in fog"  # Cycles counts the caustic as a bounce
]


@pytest.mark.parametrize(("name", "volume_bounces"), CASES)
def test_media_scatter_as_in_cycles(renderer, name, volume_bounces):
    begin(volume_bounces)
    SCENES[name]()
    tolerance = CAUSTIC if name == "glass ball in fog" else CONVERGED
    label = f"media_{name.replace(' ', '_')}_{volume_bounces}"
    is_spot, settings = name.startswith("spot"), PATHS | {"volume_bounces": volume_bounces}
    if is_spot:  # whose picture is a few bright pixels of the beam
        settings |= {"photons": 16384, "iterations": 96}
    compare_with_cycles(renderer, label, 2048 if is_spot and not volume_bounces else 512, tolerance, **settings)


@pytest.mark.long
@pytest.mark.parametrize("kind", ["POINT", "SPOT"])
def test_spheres_shine_within(renderer, kind):
    """Without MIS of the lamp, which in Cycles loses light of the fog in the lamp that was scattered before."""
    begin(8)
    camera((0.0, -6.0, 0.3), (0.0, 0.0, 0.0), 20.0)
    box((1.0, 1.0, 1.0), medium("Fog", scatter(1.0)))
    lamp = light(kind, 30.0, place(), shadow_soft_size=0.2, use_soft_falloff=False)
    lamp.data.cycles.use_multiple_importance_sampling = lamp.visible_camera = False
    compare_with_cycles(renderer, f"sphere_{kind}", 512, CAUSTIC, volume_bounces=8, **PATHS)
