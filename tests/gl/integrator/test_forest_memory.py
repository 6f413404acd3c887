# SPDX-License-Identifier: GPL-3.0-or-later
"""Forecast of the bytes that a forest of a million trees takes on a device, from forests that are smaller."""

import dataclasses

import numpy as np
import pytest
import scenes

from rppm_addon.integrator.progressive import ProgressivePhotonMapper
from rppm_addon.scene import AccelerationStructure, Instance, Instancing, Scene
from rppm_addon.scene.meshes import Mesh

TREES, TRIANGLES = 1_000_000, 100_000
DEVICE = 8_000_000_000
"""Bytes of a GPU of 8 GB."""
COUNTS = {
    AccelerationStructure.BVH: (2_000, 8_000),
    AccelerationStructure.DEEP_CUBEMAP: (32_000, 128_000),  # fewer are finer: a box lies in a hundred cells of 8,000
}
"""Numbers of trees of which the bytes are counted."""


def tree() -> Mesh:
    """A ball of leaves, each a triangle."""
    rng = np.random.default_rng(3)
    way = rng.normal(size=(TRIANGLES, 3))
    middle = way / np.linalg.norm(way, axis=1, keepdims=True) * rng.uniform(0.3, 1.0, (TRIANGLES, 1))
    positions = (middle[:, None] + rng.normal(scale=0.02, size=(TRIANGLES, 3, 3))).reshape(-1, 3).astype(np.float32)
    corners = np.arange(3 * TRIANGLES, dtype=np.int32)
    normals = np.repeat(way / np.linalg.norm(way, axis=1, keepdims=True), 3, axis=0).astype(np.float32)
    return Mesh("tree", positions, corners, normals, corners.reshape(-1, 3), np.zeros(TRIANGLES, np.int32))


def forest(count: int, mesh: Mesh, structure: AccelerationStructure) -> Scene:
    """Trees on a square, at the spacing that they have in any number, in a picture of 1920 x 1080."""
    scene = scenes.room(16, photons=65536, instancing=Instancing.TWO_LEVELS, acceleration_structure=structure)
    side = int(np.ceil(np.sqrt(count)))
    numbers = np.arange(count)
    places = 3.0 * np.stack([numbers % side - side / 2, numbers // side, 0 * numbers], axis=1)
    scene.meshes.append(mesh)
    of_mesh = len(scene.meshes) - 1
    scene.instances += [Instance(of_mesh, scenes.placed(*at), [0], "tree") for at in places.tolist()]
    return dataclasses.replace(scene, camera=dataclasses.replace(scene.camera, width=1920, height=1080))


@pytest.mark.parametrize(
    "structure", [AccelerationStructure.BVH, pytest.param(AccelerationStructure.DEEP_CUBEMAP, marks=pytest.mark.long)]
)
def test_a_million_trees_fit_a_gpu_of_8_gigabytes(mapper: ProgressivePhotonMapper, structure):
    """Bytes of each further tree, at the rate at which they grow, with those of all else: mesh, picture, photons."""
    mesh, found, counts = tree(), [], COUNTS[structure]
    for count in counts:
        mapper.build(forest(count, mesh, structure))
        found.append(sum(mapper.memory_bytes.values()))
        mapper.device_scene.acceleration.release()
    few, many = found
    of_tree = max((many - few) / (counts[1] - counts[0]), 0.0)
    assert of_tree >= 208  # of its records alone, or the growth was missed
    forecast = many + of_tree * (TREES - counts[1])
    print(f"{structure.name}: {forecast / 1e9:.2f} GB, {of_tree:.0f} bytes a tree")
    assert forecast <= DEVICE
