# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes in which things move while the shutter is open."""

import dataclasses

import numpy as np
from rendering import radiance_of

from rppm_addon.integrator.progressive import ProgressivePhotonMapper
from rppm_addon.scene import CameraMovement, Deformation, Movement, Scene, Shutter

ENDS = np.array([0.0, 1.0])
BALL = 5


def open_for(scene: Scene, **members: object) -> Scene:
    return dataclasses.replace(scene, warnings=[], shutter=Shutter(np.ones(4), **members))


def way(member: int, matrix: np.ndarray, *translation: float) -> Movement:
    """From half a translation before a place to half a one behind."""
    step = np.zeros((4, 4))
    step[:3, 3] = np.multiply(translation, 0.5)
    return Movement(member, ENDS, np.stack([matrix - step, matrix + step]))


def everything_moves(scene: Scene, amount: float) -> Scene:
    """A ball, its shape, the light and the camera, by up to so much."""
    camera, mesh = scene.camera, scene.meshes[5]
    shapes = np.stack([mesh.positions * np.float32(1.0 - 0.3 * amount), mesh.positions])
    camera_way = way(0, camera.matrix, 0.2 * amount, 0.0, 0.0)
    return open_for(
        scene,
        instances=[way(BALL, scene.instances[BALL].matrix, 0.5 * amount, 0.0, 0.2 * amount)],
        lights=[way(0, scene.lights[0].matrix, 0.6 * amount, 0.0, 0.0)],
        meshes=[Deformation(5, ENDS, shapes, np.stack([mesh.corner_normals] * 2))],
        camera=CameraMovement(ENDS, camera_way.matrices, np.array([camera.window] * 2)),
    )


def films_of_moved(mapper: ProgressivePhotonMapper, scene: Scene) -> list[np.ndarray]:
    """Radiance of a crowded room, and that after an object was moved."""
    place = np.array(scene.instances[8].matrix)
    place[:3, 3] += 0.1, -0.2, 0.1
    moved = dataclasses.replace(scene, instances=[*scene.instances])
    moved.instances[8] = dataclasses.replace(moved.instances[8], matrix=place)
    found = [radiance_of(mapper, scene)]
    mapper.update(moved)
    mapper.iterate()
    return [*found, mapper.film.read_radiance()]
