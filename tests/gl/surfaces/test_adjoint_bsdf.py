# SPDX-License-Identifier: GPL-3.0-or-later
"""Photons leave a surface by what it shows to those who look from where they go, not from where they came."""

import math

import numpy as np
import pytest
import scenes
from rendering import iterated
from support.lobes import Lobe, LobeKind, material

from rppm_addon.integrator.common.records.photon_paths import PhotonFlag
from rppm_addon.scene import Light, LightKind, Material

ANGLE = math.radians(50.0)
"""Angle of the sun to the floor's normal, radians."""

LOBES = {
    "diffuse": [Lobe(LobeKind.DIFFUSE, color=(0.9, 0.6, 0.3))],
    "translucent": [Lobe(LobeKind.TRANSLUCENT)],
    "transparent": [Lobe(LobeKind.TRANSPARENT)],
    "mirror": [Lobe(LobeKind.GLOSSY)],
    "rough metal": [Lobe(LobeKind.GLOSSY, roughness=0.5, multiscatter=False)],
    "clear glass": [Lobe(LobeKind.GLASS)],
    "rough glass": [Lobe(LobeKind.GLASS, roughness=0.5, multiscatter=False)],
    "rough refraction": [Lobe(LobeKind.REFRACTION, roughness=0.3)],
    "coated": [
        Lobe(LobeKind.DIFFUSE, 0.5), Lobe(LobeKind.GLOSSY, 0.3, roughness=0.3, multiscatter=False),
        Lobe(LobeKind.GLOSSY, 0.2),
    ],
}  # fmt: skip


def facing_mix(lobes: list[Lobe]) -> Material:
    """A surface that shows its lobes by one minus the cosine to the viewer, and black by the rest."""
    made = material("facing", *lobes)
    graph = made.graph
    facing = graph.add("layer_weight", "facing", blend=0.5)
    graph.surface = graph.add("mix_shader", "shader", fac=facing, shader_001=graph.surface)
    return made


def scattered(mapper, surface: Material) -> tuple[np.ndarray, np.ndarray]:
    """(photons, 3) flux that goes on from a sunlit floor over that which comes to it, and the cosines to its normal."""
    camera = scenes.camera((0, -1, 3), (0, 0, 0), 0.3, 8)
    sun = Light("sun", LightKind.SUN, scenes.looking((0, 0, 0), (math.sin(ANGLE), 0, -math.cos(ANGLE))), np.ones(3))
    floor = scenes.square("floor", 2.0), surface
    iterated(mapper, scenes.scene_of(camera, floor, lights=[sun], photons=131072, photon_path_length=2))
    first, second = mapper.read_photons()
    arrived = (first["flags"] & PhotonFlag.ACTIVE != 0) & (first["flags"] & PhotonFlag.ESCAPED == 0)
    share = second["flux"][arrived] / first["flux"][arrived].mean(axis=0)
    return share.astype(np.float64), np.abs(second["direction"][arrived, 2])


@pytest.mark.parametrize("name", LOBES)
def test_light_leaves_by_what_is_seen_from_there(mapper, name):
    """In each direction, a facing mix scatters the share of light that a viewer there sees."""
    plain, cosines = scattered(mapper, material("plain", *LOBES[name]))
    expected = plain * (1 - cosines[:, None])
    shown, _ = scattered(mapper, facing_mix(LOBES[name]))
    error = np.sqrt(expected.var(axis=0) / len(expected) + shown.var(axis=0) / len(shown))
    assert np.all(error <= 0.01 * expected.mean(axis=0))
    assert np.all(np.abs(shown.mean(axis=0) - expected.mean(axis=0)) <= 4 * error)
