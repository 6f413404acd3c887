# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion blur: each iteration is a moment while the shutter is open."""

import dataclasses

import numpy as np

from ..scene.motion import MovingScene
from ..scene.scene import Scene
from .geometry import box_corners, finite_bounds, fits

_GOLDEN = 0.6180339887498949
_MOMENTS = 17
"""Evenly over the time of the shutter: where what moves is looked for beforehand."""


def moment(iteration: int, seed: int) -> float:
    """Share, 0 to 1, of the light that the shutter lets pass, by which an iteration (from 1) has its time.

    Multiples of the golden ratio from a start of the seed's own: however few iterations there are, they lie spread
    evenly. The points on the lens and where photons leave are Sobol's, whose binary digits these share nothing with;
    with van der Corput's sequence each part of the lens would see a part of the time only.
    """
    start = np.random.default_rng((seed, 1)).random()
    return float((start + iteration * _GOLDEN) % 1.0)


def swept_bounds(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Lowest and highest coordinates that what moves comes to, each (3,) metres; infinite if nothing moves.

    Looked for at a few moments: in between, what turns may come out of them by a little.
    """
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    shutter = scene.shutter
    shapes = {deformation.mesh: deformation.positions for deformation in shutter.meshes}
    moving = {movement.member for movement in shutter.instances}
    moving |= {index for index, instance in enumerate(scene.instances) if instance.mesh in shapes}
    of_mesh: dict[int, list[int]] = {}
    for index in sorted(moving):
        of_mesh.setdefault(scene.instances[index].mesh, []).append(index)
    # Vertices go straight from key to key, and so stay in the box of all keys.
    boxes = {mesh: finite_bounds(shapes.get(mesh, scene.meshes[mesh].positions)) for mesh in of_mesh}
    rigid = dataclasses.replace(scene, shutter=dataclasses.replace(shutter, meshes=[]))
    scenes = MovingScene(rigid)
    for time in np.linspace(0.0, 1.0, _MOMENTS) if moving else ():
        instances = scenes.at(float(time)).instances
        for mesh, indices in of_mesh.items():
            if boxes[mesh] is None:
                continue
            matrices = np.stack([instances[index].matrix for index in indices])
            world = matrices[:, :3, :3] @ box_corners(*boxes[mesh]) + matrices[:, :3, 3:]
            world = world[fits(world)]
            low = np.minimum(low, world.min(axis=(0, 2), initial=np.inf))
            high = np.maximum(high, world.max(axis=(0, 2), initial=-np.inf))
    return low, high
