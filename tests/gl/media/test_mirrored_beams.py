# SPDX-License-Identifier: GPL-3.0-or-later
"""Beams in fog, seen straight and by way of a mirror."""

import dataclasses

import fog
import numpy as np
import pytest
from boxes import Box
from support.lobes import Lobe, LobeKind, material

from rppm_addon.scene import Camera, Light, LightKind
from rppm_addon.self_test.meshes import looking, rectangle


@pytest.mark.parametrize("volume_bounces", [pytest.param(0, marks=pytest.mark.long), 4])
def test_a_beam_in_a_mirror(renderer, volume_bounces):
    """A mirror at 45 degrees stands before fog. Straight, it is looked at from behind the mirror's back."""
    mirror = rectangle("mirror", (-1, -4, -1), (1, -2, -1), (1, -2, 1), (-1, -4, 1))
    beam = Light("beam", LightKind.SPOT, looking((0.6, -0.4, 2.0), (0.1, 0.2, 0.0)), np.full(3, 10.0), spot_angle=0.4)
    straight = Camera(looking((0, -5, 0), (0, 0, 0)), (-0.2, 0.2, -0.2, 0.2), fog.SIZE, fog.SIZE, clip_start=3.5)
    reflected = dataclasses.replace(straight, matrix=looking((-2, -3, 0), (0, -3, 0)), clip_start=0.1)
    pictures = []
    for camera in (straight, reflected):
        scene = fog.scene_of(
            camera,
            Box(scattering=(0.5, 1.0, 1.5), g=0.3).part(),
            (mirror, material("mirror", Lobe(LobeKind.GLOSSY)), np.eye(4)),
            lights=[beam],
            photons=8192,
            iterations=16,
            volume_bounces=volume_bounces,
        )
        pictures.append(fog.pictures_of(renderer, scene))
    straight, reflected = pictures[0], pictures[1][:, :, ::-1]
    level = straight.mean(axis=(0, 1, 2))
    difference = (reflected - straight).reshape(8, 2, 4, 2, 4, 3).mean(axis=(2, 4)) / level
    error = difference.std(axis=0, ddof=1) / np.sqrt(8)
    print(f"\n{difference.mean(axis=0).round(4).tolist()} +- {error.max():.4f}")
    assert error.max() < 0.2
    assert (np.abs(difference.mean(axis=0)) < 7.0 * error).all()
