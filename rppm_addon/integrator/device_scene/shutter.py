# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion blur: each iteration is a moment while the shutter is open."""

import dataclasses
from collections.abc import Sequence

import numpy as np

from ...scene.moving_scene import MovingScene
from ...scene.scene import Scene
from ..common.band import Band
from ..common.iteration import Iteration
from ..common.require import require
from ..surfaces.geometry import finite_bounds
from ..surfaces.placements import placed_boxes
from .moments import moment
from .rolling_shutter import RollingShutter

_MOMENTS = 17
"""Evenly over the time of the shutter: where what moves is looked for beforehand."""
_NOWHERE = (np.full(3, np.inf), np.full(3, -np.inf))


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

    def time_of(self, iteration: Iteration) -> float:
        """Return an iteration's moment in the time of the shutter, 0 to 1."""
        return require(self.scene.shutter).time_of(moment(iteration.number, iteration.seed))

    def scene_at(self, time: float) -> Scene:
        """Return the scene as it is at a time of the shutter."""
        return require(self._moving).at(time)

    def iterations_of_bands(self, bands: Sequence[Band], iteration: Iteration) -> list[tuple[Band, Iteration]]:
        """Return the bands that take part in an iteration, with the iteration as it is for each: all without a rolling
        shutter."""
        rolling = self._rolling_shutter(bands)
        return [(band, iteration) for band in bands] if rolling is None else rolling.iterations(iteration)

    def least_exposed(self, bands: Sequence[Band], iteration: Iteration) -> Iteration:
        """Return an iteration as the band sees it that has taken part in the film least."""
        rolling = self._rolling_shutter(bands)
        if rolling is None:
            return iteration
        return dataclasses.replace(iteration, number=rolling.least_count(iteration), skipped=0)

    def _rolling_shutter(self, bands: Sequence[Band]) -> RollingShutter | None:
        shutter = self.scene.shutter
        if shutter is None or not shutter.is_rolling:
            return None
        return RollingShutter(shutter, self.scene.camera, bands)
