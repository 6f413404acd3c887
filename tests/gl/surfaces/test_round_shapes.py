# SPDX-License-Identifier: GPL-3.0-or-later
"""Strands and points as meshes: rays meet their triangles from outside only."""

import dataclasses
import math

import numpy as np
import pytest
import scenes
from rendering import iterated
from support.lobes import Lobe, LobeKind, material

from rppm_addon.integrator.common.records.photon_paths import PhotonFlag
from rppm_addon.integrator.lights.sources import SURFACES
from rppm_addon.scene import FirstPhotonHits, Instance, Light, LightKind, MeshShape, Scene

PHOTONS, RADIUS, RADIANCE = 4096, 0.3, 5.0


def ball(shape: MeshShape, *lobes: Lobe) -> Scene:
    """A ball that stands for a surface or a point, alone."""
    mesh = dataclasses.replace(scenes.sphere("ball"), shape=shape)
    camera = scenes.camera((0, -3, 0), (0, 0, 0), 0.4, 8)
    settings = {"photons": PHOTONS, "photon_path_length": 2, "camera_path_length": 1}
    scene = scenes.scene_of(camera, (mesh, material("ball", *lobes)), **settings)
    scene.instances[0].matrix = scenes.placed(0, 0, 0, RADIUS)
    return scene


@pytest.mark.parametrize(("shape", "sides"), [(MeshShape.SURFACE, 2), (MeshShape.POINTS, 1)])
def test_points_shine_on_their_outside(mapper, shape, sides):
    """Else photons that begin within would get out, and the others get twice the light."""
    scene = ball(shape, Lobe(LobeKind.EMISSION, color=(RADIANCE, RADIANCE, RADIANCE)))
    iterated(mapper, scene)
    corners = RADIUS * scene.meshes[0].positions[scene.meshes[0].corner_vertices[scene.meshes[0].triangle_corners]]
    area = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum()
    watts = math.pi * RADIANCE * area
    balance = mapper.flux_balance()
    assert mapper.source_watts[SURFACES] == pytest.approx(sides * watts, rel=1e-4)
    # The side is chosen photon by photon.
    assert balance["emitted"] == pytest.approx(3 * sides * watts, rel=4.5 / math.sqrt(PHOTONS))
    assert balance["escaped"] == pytest.approx(3 * watts, rel=4.5 / math.sqrt(PHOTONS))


def test_first_hits_from_within_are_those_of_traced_rays(mapper):
    """Light within a point gets out."""
    scene = ball(MeshShape.POINTS, Lobe(LobeKind.DIFFUSE, color=(0.5, 0.5, 0.5)))
    scene.lights = [Light("within", LightKind.POINT, scenes.placed(0.05, 0.1, 0.0), np.ones(3))]
    scene.meshes.append(scenes.box_sides()[0])
    scene.instances.append(Instance(1, np.eye(4), [0]))
    found = []
    for scene.settings.first_photon_hits in (FirstPhotonHits.TRACED, FirstPhotonHits.RASTERIZED):
        found.append(iterated(mapper, scene, 2).read_photons())
    np.testing.assert_array_equal(found[0].tobytes(), found[1].tobytes())
    gone = found[0][0]["flags"] & PhotonFlag.ESCAPED != 0
    assert 0.1 < gone.mean() < 0.9
