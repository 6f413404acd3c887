# SPDX-License-Identifier: GPL-3.0-or-later
"""The smallest scene worth a picture."""

import numpy as np

from rppm_addon.scene import Camera, Instance, Light, LightKind, Mesh, RenderSettings, Scene
from support.lobes import Lobe, LobeKind, material


def floor_scene():
    """A camera 4 m above a diffuse floor that covers the left half of its view, lit by a point light."""
    down = np.eye(4)
    down[2, 3] = 4.0
    floor = Mesh(
        "Floor",
        positions=np.array([[-9, -9, 0], [0, -9, 0], [0, 9, 0], [-9, 9, 0]], np.float32),
        corner_vertices=np.arange(4, dtype=np.int32),
        corner_normals=np.tile(np.float32([0, 0, 1]), (4, 1)),
        triangle_corners=np.array([[0, 1, 2], [0, 2, 3]], np.int32),
        triangle_slots=np.zeros(2, np.int32),
    )
    light = np.eye(4)
    light[:3, 3] = (-1.0, 1.0, 2.0)
    return Scene(
        Camera(down, (-0.5, 0.5, -0.375, 0.375), 16, 12),
        meshes=[floor],
        instances=[Instance(0, np.eye(4), [0], "Floor")],
        materials=[material("Gray", Lobe(LobeKind.DIFFUSE, color=(0.5, 0.5, 0.5)))],
        lights=[Light("Light", LightKind.POINT, light, np.full(3, 10.0))],
        settings=RenderSettings(iterations=3, photons=1024),
    )
