# SPDX-License-Identifier: GPL-3.0-or-later
"""A thick white slab: the diffusion limit."""

import fog
import numpy as np
import pytest
import scenes
from support.lobes import Lobe, LobeKind, material

from rppm_addon.scene import Camera, Light, LightKind
from rppm_addon.self_test.meshes import rectangle

THICKNESS = 20.0
"""Optical thickness of the slab, which is 1 m thick."""
EXTRAPOLATION = 0.7104
"""Milne's extrapolation length, in mean free paths."""
TRANSMITTANCE = 4.0 / 3.0 / (THICKNESS + 2.0 * EXTRAPOLATION)
"""Transmittance for diffuse light (van de Hulst 1980, Multiple Light Scattering)."""
STRAIGHT_OUT = np.sqrt(3.0) / 4.0 * 2.9078
"""Radiance that leaves a deep medium at a right angle times pi over the flux: Hopf's law with H(1) = 2.9078
(Chandrasekhar 1960, Radiative Transfer)."""


def slab(**settings):
    """In a square pipe of mirrors, so that the slab has no end. It is lit from above, and seen from below."""
    x, low, high = 0.5, -1.0, 1.5
    corners = [(-x, -x), (x, -x), (x, x), (-x, x)]
    mirror = material("mirror", Lobe(LobeKind.GLOSSY))
    walls = [
        (rectangle("wall", (*b, low), (*a, low), (*a, high), (*b, high)), mirror, np.eye(4))
        for a, b in zip(corners, corners[1:] + corners[:1], strict=True)
    ]
    block = scenes.placed(0.0, 0.0, 0.5, 1.0) @ np.diag([0.6, 0.6, 0.5, 1.0])
    black = material("black", Lobe(LobeKind.DIFFUSE, color=(0.0, 0.0, 0.0)))
    lid = scenes.square("lid", 0.7), black, scenes.placed(0.0, 0.0, 1.4, 1.0)
    lamp = Light("lamp", LightKind.AREA, scenes.placed(0.0, 0.0, 1.39, 1.0), np.ones(3), size=(1.0, 1.0))
    up = np.diag([1.0, -1.0, -1.0, 1.0])
    up[2, 3] = -0.9
    camera = Camera(up, (-0.4, 0.4, -0.4, 0.4), fog.SIZE, fog.SIZE, orthographic=True)
    parts = [*walls, lid, (scenes.box("slab"), fog.fog(THICKNESS), block)]
    settings = {"photons": 8192, "iterations": 4, "volume_bounces": 1024} | settings
    return fog.scene_of(camera, *parts, lights=[lamp], **settings)


@pytest.mark.long
def test_transmittance(mapper):
    """By the flux of the photons that leave the open end, and by the radiance that is seen there.

    Half of the kernel's photons are missing at the surface, where most of what is seen comes from: 5/32 of a radius.
    """
    scene, radii, passed, seen = slab(), [], [], []
    for seed in range(8):
        scene.settings = scene.settings.with_values(seed=seed)
        mapper.build(scene)
        for _ in range(scene.settings.iterations):
            mapper.iterate()
            radii.append(mapper.stages.medium_photons.radius)
        flux = mapper.flux_balance()
        passed.append(flux["escaped"] / flux["emitted"])
        seen.append(np.pi * mapper.film.read_radiance()[..., :3].mean() / np.pi)
    for values, expected, bias, most_error in (
        (passed, TRANSMITTANCE, 0.005, 0.02),
        (seen, STRAIGHT_OUT * TRANSMITTANCE, 5.0 / 32.0 * max(radii) * THICKNESS, 0.06),
    ):
        error = np.std(values, ddof=1) / np.sqrt(len(values)) / expected
        ratio = np.mean(values) / expected
        print(f"\n{ratio:.4f} +- {error:.4f}, bias {bias:.4f}")
        assert error < most_error
        assert abs(ratio - 1.0) < bias + 6.0 * error
