# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion blur: each iteration is a moment while the shutter is open."""

import dataclasses

import numpy as np

from ...scene.moving_scene import MovingScene
from ...scene.scene import Scene
from ..common.iteration import Iteration
from ..common.low_discrepancy import van_der_corput
from ..common.require import require
from ..surfaces.geometry import finite_bounds
from ..surfaces.placements import placed_boxes

_MOMENTS = 17
"""Evenly over the time of the shutter: where what moves is looked for beforehand."""
_NOWHERE = (np.full(3, np.inf), np.full(3, -np.inf))


def moment(iteration: int, seed: int) -> float:
    """Return the time of an iteration (from 1) as the fraction, 0 to 1, of the light that the shutter lets pass before.

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


class SceneMotion:
    """Motion of a scene while its shutter is open; a scene without a shutter does not move."""

    def __init__(self) -> None:
        self._scene: Scene | None = None
        self._moving: MovingScene | None = None
        self.swept = _NOWHERE
        """Bounds of the space that things move through (swept_bounds)."""

    @property
    def moves(self) -> bool:
        """Whether iterations have moments of their own."""
        return self._moving is not None

    @property
    def scene(self) -> Scene:
        """The scene, its shutter included."""
        return require(self._scene)

    def take(self, scene: Scene) -> bool:
        """Take a scene; returns whether its things move through another space than before."""
        self._scene = scene
        self._moving = MovingScene(scene) if scene.shutter is not None else None
        before, self.swept = self.swept, swept_bounds(scene)
        return not np.array_equal(self.swept, before)

    def scene_at(self, iteration: Iteration) -> Scene:
        """Return the scene as it is at an iteration's moment."""
        time = require(self.scene.shutter).time_of(moment(iteration.number, iteration.seed))
        return require(self._moving).at(time)
