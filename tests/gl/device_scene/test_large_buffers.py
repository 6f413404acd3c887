# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures whose buffers are larger than a device allows a storage block to be are those of any other device."""

import dataclasses

import numpy as np
import pytest
import scenes
from busy_scenes import busy_room
from rendering import iterated

from rppm_addon.scene.settings import AccelerationStructure, DensityEstimation


def picture_of(mapper, scene, iterations=2):
    """The film, and the buffers that are larger than a storage block."""
    iterated(mapper, scene, iterations)
    limit = mapper.context.storage_block_limit
    return mapper.film.read_radiance(), {name for name, size in mapper.memory_bytes.items() if size > limit}


def with_blocks_of(context, monkeypatch, limit):
    monkeypatch.setitem(context.limits, "GL_MAX_SHADER_STORAGE_BLOCK_SIZE", limit)


@pytest.mark.parametrize(("structure", "longest"), [
    (AccelerationStructure.DEEP_CUBEMAP, "deep cubemap fragments"), (AccelerationStructure.BVH, "BVH nodes"),
])  # fmt: skip
def test_many_triangles(mapper, other_mapper, context, monkeypatch, structure, longest):
    scene = scenes.room(16, photons=128, camera_path_length=3, photon_path_length=3, acceleration_structure=structure)
    scene.meshes.append(scenes.sphere("ball", 64, 40))
    matrix = np.diag([0.3, 0.3, 0.3, 1.0])
    ball = dataclasses.replace(scene.instances[0], mesh=len(scene.meshes) - 1, matrix=matrix)
    scene.instances.append(ball)
    expected, large = picture_of(mapper, scene)
    assert not large
    with_blocks_of(context, monkeypatch, 1 << 17)
    found, large = picture_of(other_mapper, scene)
    assert {"world triangles", "triangle attributes", "geometry CornerNormals", longest} <= large
    np.testing.assert_array_equal(found, expected)


@pytest.mark.parametrize(
    "route", [DensityEstimation.GRID, pytest.param(DensityEstimation.RASTERIZED, marks=pytest.mark.long)]
)
def test_many_photons(mapper, other_mapper, context, monkeypatch, route):
    """Some of which go on by what a viewer would see who looks back."""
    scene = busy_room()
    scene.settings = dataclasses.replace(scene.settings, passes=("Depth",), density_estimation=route)
    expected, _ = picture_of(mapper, scene)
    balance = mapper.flux_balance()
    with_blocks_of(context, monkeypatch, 800_000)
    found, large = picture_of(other_mapper, scene)
    assert other_mapper.device_scene.materials.any_depends_on_view
    assert large == {"photons", "photon closures"}
    np.testing.assert_array_equal(found, expected)
    assert other_mapper.flux_balance() == balance
