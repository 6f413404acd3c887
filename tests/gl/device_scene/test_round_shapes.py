# SPDX-License-Identifier: GPL-3.0-or-later
"""Strands and points as meshes: rays meet their triangles from outside only."""

import dataclasses
import math

import numpy as np
import pytest
import scenes
from photon_hits import both_hits
from support.lobes import Lobe, LobeKind, material

from rppm_addon.integrator.common.records.rays import NO_TRIANGLE
from rppm_addon.integrator.lights.sources import SURFACES
from rppm_addon.scene import Camera, Instance, Light, LightKind, MeshShape, RenderSettings, Scene

PHOTONS, RADIUS, RADIANCE = 4096, 0.3, 5.0


def ball(shape: MeshShape, *lobes: Lobe) -> Scene:
    """A ball that stands for a surface or a point, alone."""
    camera = Camera(scenes.looking((0, -3, 0), (0, 0, 0)), (-0.4, 0.4, -0.4, 0.4), 8, 8)
    mesh = dataclasses.replace(scenes.sphere("ball"), shape=shape)
    settings = RenderSettings(photons=PHOTONS, photon_path_length=2, camera_path_length=1)
    instances = [Instance(0, scenes.placed(0, 0, 0, RADIUS), [0])]
    return Scene(camera, [mesh], instances, [material("ball", *lobes)], settings=settings)


@pytest.mark.parametrize(("shape", "sides"), [(MeshShape.SURFACE, 2), (MeshShape.POINTS, 1)])
def test_points_shine_on_their_outside(mapper, shape, sides):
    """Else photons that begin within would get out, and the others get twice the light."""
    scene = ball(shape, Lobe(LobeKind.EMISSION, color=(RADIANCE, RADIANCE, RADIANCE)))
    mapper.build(scene)
    mapper.iterate()
    corners = RADIUS * scene.meshes[0].positions[scene.meshes[0].corner_vertices[scene.meshes[0].triangle_corners]]
    area = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum()
    watts = math.pi * RADIANCE * area
    balance = mapper.flux_balance()
    assert mapper.source_watts[SURFACES] == pytest.approx(sides * watts, rel=1e-4)
    # The side is chosen photon by photon.
    assert balance["emitted"] == pytest.approx(3 * sides * watts, rel=4.5 / math.sqrt(PHOTONS))
    assert balance["escaped"] == pytest.approx(3 * watts, rel=4.5 / math.sqrt(PHOTONS))


def test_first_hits_from_within_are_those_of_traced_rays(mapper, library):
    """Light within a point gets out."""
    scene = ball(MeshShape.POINTS, Lobe(LobeKind.DIFFUSE, color=(0.5, 0.5, 0.5)))
    scene.lights = [Light("within", LightKind.POINT, scenes.placed(0.05, 0.1, 0.0), np.ones(3))]
    scene.meshes.append(scenes.box_sides()[0])
    scene.instances.append(Instance(1, np.eye(4), [0]))
    traced, rasterized, settled = both_hits(mapper, library, scene)
    np.testing.assert_array_equal(traced.view(np.uint32), rasterized.view(np.uint32))
    hit = traced["triangle"] != NO_TRIANGLE
    assert 0.1 < hit.mean() < 0.5 and settled < 0.1  # what the texels tell of is not met
