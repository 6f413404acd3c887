# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes far from the world's origin, brought near the device's.

A float32 has steps of 2 mm at 20 km and of 6 cm at 1,000 km, which matrices in double precision need not have. So the
world's coordinates, before they become float32, are counted from a place near what the camera sees; nodes and passes
that show them add it again (Scene.world_origin). Where that place is follows from the scene alone, so that a frame has
the same bits in whatever order frames are rendered, and for a scene around the origin it is the origin.
"""

import dataclasses
from collections.abc import Callable
from typing import Any

import numpy as np

from ...scene.camera import Camera
from ...scene.lights import Light, LightKind
from ...scene.meshes import Instance
from ...scene.motion import CameraMovement, Movement, Shutter
from ...scene.scene import Scene
from ..surfaces.geometry import finite_bounds, placed_boxes

CELL = 256.0
"""Meters between places to count from: within half of it coordinates have steps of less than 8 micrometers."""
_FARTHEST = 1e15
"""Meters from which on nothing is rendered (placed_boxes)."""


class Centering:
    """Centered scenes, which share their members as the scenes do that they are made of."""

    def __init__(self) -> None:
        self._origin = np.zeros(3)
        self._made: dict[int, tuple[Any, Any]] = {}
        """Centered members by the id of the members they were made of, which these keep theirs."""
        self._boxes: dict[int, tuple[np.ndarray, Any]] = {}
        """Bounds of positions by their id, and the positions."""

    def centered(self, scene: Scene) -> Scene:
        """The scene with its places counted from Scene.world_origin; itself where that is the world's origin.

        Suns stay, as they have no place, and so do particles, whose places only nodes ask for.
        """
        origin = self._origin_of(scene)
        if not origin.any():
            self._made = {}
            return scene
        if not np.array_equal(origin, self._origin):
            self._origin, self._made = origin, {}
        before, self._made = self._made, {}

        def once(member: Any, make: Callable[[Any], Any]) -> Any:
            made = self._made[id(member)] = before.get(id(member)) or (member, make(member))
            return made[1]

        def moved(member: Instance | Light) -> Instance | Light:
            return dataclasses.replace(member, matrix=_shifted(member.matrix, origin))

        def shutter_of(shutter: Shutter | None) -> Shutter | None:
            return None if shutter is None else once(shutter, lambda it: _shifted_shutter(it, scene, origin))

        center = scene.cubemap_center
        return dataclasses.replace(
            scene,
            world_origin=scene.world_offset + origin,
            camera=once(scene.camera, lambda camera: _shifted_camera(camera, origin)),
            instances=[once(instance, moved) for instance in scene.instances],
            lights=[light if light.kind is LightKind.SUN else once(light, moved) for light in scene.lights],
            cubemap_center=None if center is None else once(center, lambda place: np.asarray(place) - origin),
            shutter=shutter_of(scene.shutter),
            neighbors=shutter_of(scene.neighbors),
        )

    def _origin_of(self, scene: Scene) -> np.ndarray:
        """(3,) meters, on a grid that float32 has exactly: by the place of the scene nearest to the camera.

        A camera far from all it sees says nothing of where fine coordinates are needed.
        """
        texels = scene.camera.texels
        if texels is not None and texels.see_environment:  # seen from the world's origin
            return np.zeros(3)
        matrix = scene.camera.matrix if texels is None else scene.instances[texels.instance].matrix
        place = np.asarray(matrix, np.float64)[:3, 3]
        if not (np.abs(place) < _FARTHEST).all() or not _cell(place).any():
            return np.zeros(3)
        low, high = self._bounds_of(scene)
        return _cell(place if (low > high).any() else np.clip(place, low, high))

    def _bounds_of(self, scene: Scene) -> tuple[np.ndarray, np.ndarray]:
        """Lowest and highest coordinates of the instances, each (3,) meters; infinite without any."""
        before, self._boxes = self._boxes, {}
        boxes = []
        for positions in (scene.meshes[instance.mesh].positions for instance in scene.instances):
            if id(positions) not in self._boxes:
                self._boxes[id(positions)] = before.get(id(positions)) or (positions, finite_bounds(positions))
            boxes.append(self._boxes[id(positions)][1])
        found = [index for index, box in enumerate(boxes) if box is not None]
        if not found:
            return np.full(3, np.inf), np.full(3, -np.inf)
        matrices = np.array([scene.instances[index].matrix for index in found], np.float64)
        lows, highs, good = placed_boxes(matrices, np.array([boxes[index] for index in found]))
        return lows[good].min(axis=0, initial=np.inf), highs[good].max(axis=0, initial=-np.inf)


def _cell(place: np.ndarray) -> np.ndarray:
    return CELL * np.round(place / CELL)


def _shifted(matrices: np.ndarray, origin: np.ndarray) -> np.ndarray:
    """Matrices (..., 4, 4) to the world, counted from the origin."""
    result = np.array(matrices, np.float64)
    result[..., :3, 3] -= origin
    return result


def _shifted_camera(camera: Camera, origin: np.ndarray) -> Camera:
    texels = camera.texels
    if texels is not None and texels.viewer is not None:
        *place, is_place = texels.viewer
        x, y, z = np.array(place) - is_place * origin
        texels = dataclasses.replace(texels, viewer=(float(x), float(y), float(z), is_place))
    return dataclasses.replace(camera, matrix=_shifted(camera.matrix, origin), texels=texels)


def _shifted_shutter(shutter: Shutter, scene: Scene, origin: np.ndarray) -> Shutter:
    def shifted(movement: Any) -> Any:
        return dataclasses.replace(movement, matrices=_shifted(movement.matrices, origin))

    def of_light(movement: Movement) -> Movement:
        return movement if scene.lights[movement.member].kind is LightKind.SUN else shifted(movement)

    camera: CameraMovement | None = shutter.camera
    return dataclasses.replace(
        shutter,
        instances=[shifted(movement) for movement in shutter.instances],
        lights=[of_light(movement) for movement in shutter.lights],
        camera=None if camera is None else shifted(camera),
    )
