# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion blur: each iteration is a moment while the shutter is open."""

import dataclasses

import numpy as np

from ...scene.moving_scene import MovingScene
from ...scene.scene import Scene
from ..common.low_discrepancy import van_der_corput
from ..surfaces.geometry import finite_bounds, placed_boxes

_MOMENTS = 17
"""Evenly over the time of the shutter: where what moves is looked for beforehand."""


def moment(iteration: int, seed: int) -> float:
    """Share, 0 to 1, of the light that the shutter lets pass, by which an iteration (from 1) has its time.

    Of 2^k iterations each has a 2^k-th of the time, and a random place in it. That the points of what else an
    iteration decides go through their indices in a shuffled order keeps it, such as the place on the lens, independent
    of the time.
    """
    scramble = int(np.random.default_rng((seed, 1)).integers(1 << 32))
    return van_der_corput(iteration - 1, scramble)


def swept_bounds(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Lowest and highest coordinates that what moves comes to, each (3,) meters; infinite if nothing moves.

    Looked for at a few moments: in between, what turns may come out of them by a little.
    """
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    shutter = scene.shutter
    if shutter is None:
        return low, high
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
            lows, highs, good = placed_boxes(matrices, np.array([boxes[mesh]]))
            low = np.minimum(low, lows[good].min(axis=0, initial=np.inf))
            high = np.maximum(high, highs[good].max(axis=0, initial=-np.inf))
    return low, high
