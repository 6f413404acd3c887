# SPDX-License-Identifier: GPL-3.0-or-later
"""Lamps with a radius in fog: photons bring the light that shadow rays find."""

import fog
import pytest
from boxes import Box

from rppm_addon.scene import DirectLight, LightKind, RayVisibility

FOG = Box((0.0, 0.0, 0.0), 1.0, 2.0)
"""Too dense for beams."""
KERNEL_BIAS = 0.09
"""Difference by the photons' kernel, which spreads the glow of a lamp: that of lamps without size is 6 %."""


@pytest.mark.parametrize("kind", [LightKind.POINT, LightKind.SPOT], ids=str)
@pytest.mark.parametrize("is_soft", [True, False], ids=["disk", "sphere"])
def test_photons_bring_what_shadow_rays_find(renderer, kind, is_soft):
    lamp = fog.lamp(0.0, 0.0, 0.0)
    lamp.kind, lamp.radius, lamp.soft_falloff, lamp.spot_angle = kind, 0.4, is_soft, 1.0
    lamp.visibility &= ~RayVisibility.CAMERA
    camera = fog.camera((0.3, -4.0, 0.5), (0.0, 0.0, 0.0), 0.3, 32)
    means = []
    for mode in DirectLight.RAYS, DirectLight.PHOTONS:
        scene = fog.scene_of(camera, FOG.part(), lights=[lamp], volume_bounces=0, direct_light=mode)
        means.append(fog.pictures_of(renderer, scene, 3).mean(axis=(1, 2, 3)))
    by_rays, by_photons = (values.mean() for values in means)
    print(f"\n{kind}: {by_photons / by_rays:.4f}")
    assert by_photons == pytest.approx(by_rays, rel=KERNEL_BIAS)
