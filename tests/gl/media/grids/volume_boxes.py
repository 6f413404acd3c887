# SPDX-License-Identifier: GPL-3.0-or-later
"""A volume in a box, looked at from above."""

import dataclasses

import numpy as np
import scenes
from support.lobes import Lobe, LobeKind, material

from rppm_addon.scene import (
    Instance,
    Material,
    NodeGraph,
    RenderSettings,
    Scene,
    Volume,
    VolumeGrid,
    World,
)

SIZE = 8
VOXELS = 12
STEP = 0.2
"""Meters between voxels."""
COLOR = np.array([0.2, 0.5, 1.0])
"""Absorption at a density of 1, 1/m."""


def grid_of(function, channels: int = 1) -> VolumeGrid:
    """A function of the places of voxels (x, y, z, 3) around the origin, with a border of zeros."""
    matrix = np.diag([STEP, STEP, STEP, 1.0])
    matrix[:3, 3] = -STEP * (VOXELS - 1) / 2
    places = np.stack(np.meshgrid(*[np.arange(VOXELS)] * 3, indexing="ij"), -1) * STEP + matrix[:3, 3]
    values = np.zeros((*[VOXELS] * 3, channels), np.float32)
    values[1:-1, 1:-1, 1:-1] = np.reshape(function(places), (*[VOXELS] * 3, -1))[1:-1, 1:-1, 1:-1]
    return VolumeGrid(values, matrix)


def smoke() -> Material:
    """Absorption by the attribute "density"."""
    graph = NodeGraph()
    density = graph.add("attribute", "fac", attribute="density")
    graph.surface = graph.add("volume_absorption", "volume", color=(0.8, 0.5, 0.0), density=density)
    return Material("smoke", material("clear", Lobe(LobeKind.TRANSPARENT)).graph, graph, reads_grids=True)


def scene_of(volume: Volume, surface: Material | None = None, matrix: np.ndarray | None = None, **settings) -> Scene:
    mesh = dataclasses.replace(scenes.box("volume", STEP * (VOXELS - 1) / 2), volume=volume)
    settings = {"iterations": 16, "photons": 16, "filter_width": 0.0} | settings
    instance = Instance(0, np.eye(4) if matrix is None else matrix, [0])
    camera = scenes.camera((0, 0, 5), (0, 0, 0), 0.8, SIZE, orthographic=True)
    return Scene(
        camera, [mesh], [instance], [surface or smoke()], [], World(np.ones(3)), settings=RenderSettings(**settings)
    )


def picture(renderer, scene: Scene) -> np.ndarray:
    frame = renderer.render(scene).frame
    assert scene.warnings == []
    return frame.combined[..., :3]
