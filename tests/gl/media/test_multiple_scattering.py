# SPDX-License-Identifier: GPL-3.0-or-later
"""Light that media scatter several times, against path tracing in NumPy."""

import boxes
import fog
import numpy as np
import pytest
import scenes
from boxes import Box
from support.lobes import Lobe, LobeKind, material

LAMP = (0.3, 0.2, 1.5)
KERNEL_LOSS = 5.0 / 32.0 * 0.1 * 1.7
"""Fraction of the light that the kernel misses at the surfaces: its radius is some 0.1 m."""
GRAY = Box((0.0, 0.0, 0.0), 1.0, 1.5, 0.2)


@pytest.mark.parametrize("bounces", [0, 1, 2, pytest.param(20, marks=pytest.mark.long)])
@pytest.mark.parametrize("g", [0.0, 0.5])
def test_volume_bounces(renderer, bounces, g):
    camera = fog.camera((0.3, -4.0, 0.5), (0.0, 0.0, 0.0), 0.15)
    box = Box(GRAY.center, GRAY.half, GRAY.scattering, GRAY.absorption, g)
    scene = fog.scene_of(
        camera, box.part(), lights=[fog.lamp(*LAMP)], photons=16384, iterations=6, volume_bounces=bounces
    )
    rng = np.random.default_rng(2)  # not that of the walks
    x, y = camera.window[1] * (2.0 * rng.random((2, 400_000)) - 1.0)
    origin, _ = fog.rays(camera)
    way = np.stack([x, y, -np.ones_like(x)], axis=-1) @ camera.matrix[:3, :3].T
    way /= np.linalg.norm(way, axis=-1, keepdims=True)
    means, errors = boxes.traced_orders(box, np.array(LAMP), origin, way, min(bounces + 1, 30))
    expected, error = means[-1], errors[-1]
    scene.settings.filter_width = 1.0
    found = fog.pictures_of(renderer, scene).mean(axis=(1, 2, 3)) / expected
    mean, noise = found.mean(), np.hypot(found.std(ddof=1) / np.sqrt(len(found)), error / expected)
    print(f"\n{bounces} bounces, g {g}: {mean:.4f} +- {noise:.4f}")
    assert noise < 0.03
    assert abs(mean - 1.0) < KERNEL_LOSS + 6.0 * noise


def test_light_that_rough_metal_sends_to_fog(renderer):
    """Camera paths that fog scatters find it by photons where they are scattered, as gathering rays do not look for it.
    Without a final gather, photons alone bring all light."""
    metal = material("metal", Lobe(LobeKind.GLOSSY, roughness=0.3, color=(0.4, 0.4, 0.4)))
    plates = [(scenes.square("plate", 1.5), metal, scenes.placed(0.0, 0.0, z, 1.0)) for z in (-0.6, 0.6)]
    found = []
    for gathers in (True, False):
        scene = fog.scene_of(
            fog.camera((0.0, -3.0, 0.1), (0.0, 0.0, 0.0), 0.15), *plates, Box(scattering=2.5, half=0.9).part(),
            lights=[fog.lamp(1.4, 0.0, 0.1)], iterations=24, photons=8192, volume_bounces=4, max_bounces=12,
            use_final_gather=gathers,
        )  # fmt: skip
        found.append(fog.pictures_of(renderer, scene).mean(axis=(1, 2, 3)))
    with_rays, photons = found
    ratio = with_rays.mean() / photons.mean()
    noise = ratio * np.hypot(*(means.std(ddof=1) / np.sqrt(len(means)) / means.mean() for means in found))
    print(f"\nratio {ratio:.4f} +- {noise:.4f}")
    assert noise < 0.01
    assert abs(ratio - 1.0) < KERNEL_LOSS + 4.0 * noise
